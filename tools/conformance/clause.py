"""A clause of a driver's contract: a named function that yields what a driver does wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace

from tailor.tools.conformance.bench import PERIOD_S, Bench, NotPossible

MAX_STALL_S = PERIOD_S  # of this process: a command that comes a period late, three make any driver stop
TRIES = 3  # of a clause during which this process stalled

Check = Callable[[Bench], Iterator[str]]


@dataclass(frozen=True, slots=True)
class Clause:
    """One clause; `text` states what a driver must keep to."""

    name: str
    text: str
    check: Check


@dataclass(frozen=True, slots=True)
class Verdict:
    """The outcome of one clause.

    Attributes:
      clause: Its name.
      text: What the driver must keep to.
      faults: What it does wrong.
      skipped: Why the clause could not be tried; empty if it was.
    """

    clause: str
    text: str
    faults: tuple[str, ...] = ()
    skipped: str = ""


CLAUSES: dict[str, Clause] = {}


def clause(check: Check) -> Check:
    """Register a function as a clause; its name and its docstring are those of the clause."""
    CLAUSES[check.__name__] = Clause(check.__name__, " ".join((check.__doc__ or "").split()), check)
    return check


def judged(bench: Bench, clauses: Iterable[Clause]) -> Iterator[Verdict]:
    """The verdict of each clause, each from rest; at the end the driver is disarmed.

    A driver that keeps a clause has kept it. One that does not, while this process stalled and sent its commands late,
    proves nothing and is tried again; without a measured stall the first verdict counts.
    """
    for each in clauses:
        for left in reversed(range(TRIES)):
            bench.link.stalled_s()
            verdict = _verdict(bench, each)
            stalled_s = bench.link.stalled_s()
            kept = not (verdict.faults or verdict.skipped)
            if kept or stalled_s <= MAX_STALL_S:
                break
            if not left:
                note = f"this process stalled for {stalled_s:.2f} s meanwhile: try on a machine with less to do"
                verdict = replace(verdict, skipped=f"{verdict.skipped}; {note}".removeprefix("; "))
        yield verdict
    with suppress(NotPossible):
        bench.begin()


def _verdict(bench: Bench, each: Clause) -> Verdict:
    try:
        bench.begin()
        return Verdict(each.name, each.text, tuple(each.check(bench)))
    except NotPossible as error:
        return Verdict(each.name, each.text, skipped=str(error))
