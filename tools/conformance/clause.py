"""A clause of a driver's contract: a named function that yields what a driver does wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass

from tailor.tools.conformance.bench import Bench, NotPossible

Check = Callable[[Bench], Iterator[str]]


@dataclass(frozen=True, slots=True)
class Clause:
    """One clause; `text` says what a driver must keep to."""

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
    """The verdict of each clause, each from rest; at the end the driver is disarmed."""
    for each in clauses:
        try:
            bench.begin()
            faults = tuple(each.check(bench))
        except NotPossible as error:
            yield Verdict(each.name, each.text, skipped=str(error))
        else:
            yield Verdict(each.name, each.text, faults)
    with suppress(NotPossible):
        bench.begin()
