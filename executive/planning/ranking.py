"""Ranks plans: a list of quantities, compared from left to right, the smallest first.

Source: Younes & Simmons, JAIR 20 (2003), section 3: ADD and its reuse-aware kind ADDR.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from executive.planning.ground_task import GroundTask
from executive.planning.makespan import makespan_estimate
from executive.planning.partial_plan import PartialPlan
from schemas.errors import UsageError

Rank = tuple[float, ...]
Estimate = tuple[float, float]  # cost, work of the open conditions
_Term = Callable[[PartialPlan, Estimate, int], float]

DEFAULT_RANKINGS = ("ADDR", "ADDR_WORK", "BUC", "LIFO")
MAKESPAN_RANKINGS = ("ADDR", "MAKESPAN", "LIFO")
NAMES = (
    "LIFO", "FIFO", "OC", "UC", "BUC", "S+OC", "UCPOP", "ADD", "ADD_COST", "ADD_WORK", "ADDR", "ADDR_COST",
    "ADDR_WORK", "MAKESPAN",
)  # fmt: skip


class Ranking:
    """The rank of a plan, with its number of creation as the last word: of equals the newest first."""

    def __init__(self, names: tuple[str, ...], task: GroundTask, weight: float) -> None:
        chosen = tuple(name.upper() for name in names)
        for name in chosen:
            if name not in NAMES:
                raise UsageError(f"ranking '{name}' is unknown; expected some of {', '.join(NAMES)}, joined by '/'")
        self._task = task
        self._terms = tuple(_term(name, task, weight) for name in chosen)
        self._with_reuse = any(name.startswith("ADDR") for name in chosen)
        self._without = any(name in ("ADD", "ADD_COST", "ADD_WORK") for name in chosen)
        if self._with_reuse and self._without:
            raise UsageError("rankings ADD* and ADDR* exclude each other")

    def rank(self, plan: PartialPlan, number: int) -> Rank | None:
        """The rank of the plan that was created as the `number`-th; None when its first quantity is infinite."""
        estimate: Estimate = (0, 0)
        if self._with_reuse:
            estimate = reuse_estimate(plan, self._task)
        elif self._without:
            estimate = plain_estimate(plan, self._task)
        if estimate[0] == math.inf:
            return None
        return (*[term(plan, estimate, number) for term in self._terms], -number)


def _term(name: str, task: GroundTask, weight: float) -> _Term:
    terms: dict[str, _Term] = {
        "LIFO": lambda plan, estimate, number: -number,
        "FIFO": lambda plan, estimate, number: number,
        "OC": lambda plan, estimate, number: plan.open_count,
        "UC": lambda plan, estimate, number: plan.threat_count,
        "BUC": lambda plan, estimate, number: plan.threat_count > 0,
        "S+OC": lambda plan, estimate, number: plan.cost + weight * plan.open_count,
        "UCPOP": lambda plan, estimate, number: plan.cost + weight * (plan.open_count + plan.threat_count),
        "MAKESPAN": lambda plan, estimate, number: makespan_estimate(plan, task),
    }
    if name.endswith("_COST"):
        return lambda plan, estimate, number: estimate[0]
    if name.endswith("_WORK"):
        return lambda plan, estimate, number: estimate[1]
    return terms.get(name, lambda plan, estimate, number: plan.cost + weight * estimate[0])


def plain_estimate(plan: PartialPlan, task: GroundTask) -> Estimate:
    """Cost and work of all open conditions as if each were achieved for itself."""
    cost: float = 0
    work: float = 0
    cell = plan.open
    while cell is not None:
        value = task.estimates.of(cell.condition)
        cost += value.cost
        work += value.work
        cell = cell.rest
    return cost, work


def reuse_estimate(plan: PartialPlan, task: GroundTask) -> Estimate:
    """As `plain_estimate`, but what a step of the plan may already provide costs nothing, and one unit of work."""
    costs, works = task.estimates.cost, task.estimates.work
    late = plan.orderings.late
    effects = plan.effects
    known, bits, node = effects.known, effects.bits, effects.node
    cost: float = 0
    work: float = 0
    cell = plan.open
    while cell is not None:
        condition, first, _, cell = cell
        if isinstance(condition, int):
            mask = known[condition]
            if bits is not None and condition in bits:
                mask |= bits[condition] << node
            if mask & ~late[first]:
                work += 1
            else:
                cost += costs[condition]
                work += works[condition]
        else:
            value = task.estimates.of(condition)
            cost += value.cost
            work += value.work
    return cost, work
