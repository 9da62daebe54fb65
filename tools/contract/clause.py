"""A clause of the contract: a named function that yields what a package does wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

from tailor.tools.contract.subject import Subject

Scope = Literal["package", "action", "scenario"]
Check = Callable[[Subject, str], Iterator[str]]


@dataclass(frozen=True, slots=True)
class Clause:
    """One clause.

    Attributes:
      name: Its name in the tests' ids.
      scope: What it is checked for: once, for each action or for each scenario.
      text: What a package must keep to.
      needs: Part of the package without which it is skipped: "body", "sampler", "scene" or nothing.
      check: Yields the faults of a subject in one case: the name of an action or of a scenario, "" otherwise.
    """

    name: str
    scope: Scope
    text: str
    needs: str
    check: Check


CLAUSES: dict[str, Clause] = {}


def clause(scope: Scope, needs: str = "") -> Callable[[Check], Check]:
    """Register a function as a clause; its name and its docstring are those of the clause."""

    def registered(check: Check) -> Check:
        text = " ".join((check.__doc__ or "").split())
        CLAUSES[check.__name__] = Clause(check.__name__, scope, text, needs, check)
        return check

    return registered
