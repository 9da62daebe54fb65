"""All clauses in the order in which they are tried: first what a driver publishes, then arming, then motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tailor.tools.conformance import motion_clauses, publishing_clauses, refusal_clauses
from tailor.tools.conformance.bench import Bench
from tailor.tools.conformance.clause import CLAUSES, Clause, Verdict, judged

SOURCES = (publishing_clauses, refusal_clauses, motion_clauses)  # their import fills CLAUSES


def clauses() -> list[Clause]:
    """All clauses, in order."""
    modules = [source.__name__ for source in SOURCES]
    return sorted(CLAUSES.values(), key=lambda each: modules.index(each.check.__module__))


def verdicts(bench: Bench, names: Sequence[str] = ()) -> Iterator[Verdict]:
    """The verdicts of all clauses, or of those that are named, one after the other."""
    return judged(bench, [each for each in clauses() if not names or each.name in names])
