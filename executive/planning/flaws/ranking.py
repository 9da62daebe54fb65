"""Ranks of plans: tuples of quantities, compared from left to right, smallest first.

Source: Younes & Simmons, JAIR 20 (2003), section 3: ADD and its reuse-aware variant ADDR.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Generic, Protocol, TypeVar

from tailor.executive.planning.structures.refinable import Refinable
from tailor.schemas.errors import UsageError

Rank = tuple[float, ...]
Estimate = tuple[float, float]  # cost and work of the open conditions
P = TypeVar("P", bound=Refinable)
P_contra = TypeVar("P_contra", bound=Refinable, contravariant=True)

NAMES = (
    "LIFO", "FIFO", "OC", "UC", "BUC", "S+OC", "UCPOP", "ADD", "ADD_COST", "ADD_WORK", "ADDR", "ADDR_COST",
    "ADDR_WORK", "MAKESPAN",
)  # fmt: skip

_PLAIN = ("ADD", "ADD_COST", "ADD_WORK")


def check_rankings(names: tuple[str, ...]) -> tuple[str, ...]:
    """The names in upper case.

    Raises:
      UsageError: An unknown ranking, or rankings with and without reuse in one list.
    """
    chosen = tuple(name.upper() for name in names)
    for given, name in zip(names, chosen, strict=True):
        if name not in NAMES:
            raise UsageError(f"ranking '{given}' is unknown; expected some of {', '.join(NAMES)}, joined by '/'")
    if any(name.startswith("ADDR") for name in chosen) and any(name in _PLAIN for name in chosen):
        raise UsageError("rankings ADD* and ADDR* exclude each other")
    return chosen


class PlanEstimates(Protocol[P_contra]):
    """Interface of the heuristic estimates of a plan's open conditions."""

    def plain(self, plan: P_contra) -> Estimate:
        """Cost and work with every condition achieved independently."""
        ...

    def reusing(self, plan: P_contra) -> Estimate:
        """As `plain`, but a condition that a step of the plan may achieve costs nothing and one unit of work."""
        ...

    def makespan(self, plan: P_contra) -> float:
        """The least makespan in ticks (without durations: levels)."""
        ...


class Ranking(Generic[P]):
    """The rank of a plan; its number of generation comes last: among equals the newest first."""

    def __init__(self, names: tuple[str, ...], estimates: PlanEstimates[P], weight: float) -> None:
        chosen = check_rankings(names)
        reusing = any(name.startswith("ADDR") for name in chosen)
        plain = any(name in _PLAIN for name in chosen)
        self._estimate = estimates.reusing if reusing else estimates.plain if plain else None
        if chosen[-1:] == ("LIFO",):
            chosen = chosen[:-1]  # every rank ends with it
        self._weight = weight
        self._is_default = chosen in (("ADD", "ADD_WORK", "BUC"), ("ADDR", "ADDR_WORK", "BUC"))
        self._terms = tuple(_term(name, estimates, weight) for name in chosen)

    def rank(self, plan: P, number: int) -> Rank | None:
        """The rank of the `number`-th plan generated; None if its cost estimate is infinite."""
        estimate = self._estimate(plan) if self._estimate is not None else (0, 0)
        if estimate[0] == math.inf:
            return None
        if self._is_default:  # written out for speed: most plans are only ranked, never refined
            cost, work = estimate
            return (plan.cost + self._weight * cost, work, plan.threat_count > 0, -number)
        return (*[term(plan, estimate, number) for term in self._terms], -number)


def _term(name: str, estimates: PlanEstimates[P], weight: float) -> Callable[[P, Estimate, int], float]:
    terms: dict[str, Callable[[P, Estimate, int], float]] = {
        "LIFO": lambda plan, estimate, number: -number,
        "FIFO": lambda plan, estimate, number: number,
        "OC": lambda plan, estimate, number: plan.open_count,
        "UC": lambda plan, estimate, number: plan.threat_count,
        "BUC": lambda plan, estimate, number: plan.threat_count > 0,
        "S+OC": lambda plan, estimate, number: plan.cost + weight * plan.open_count,
        "UCPOP": lambda plan, estimate, number: plan.cost + weight * (plan.open_count + plan.threat_count),
        "MAKESPAN": lambda plan, estimate, number: estimates.makespan(plan),
    }
    if name.endswith("_COST"):
        return lambda plan, estimate, number: estimate[0]
    if name.endswith("_WORK"):
        return lambda plan, estimate, number: estimate[1]
    return terms.get(name, lambda plan, estimate, number: plan.cost + weight * estimate[0])
