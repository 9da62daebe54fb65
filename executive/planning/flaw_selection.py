"""Chooses the flaw to work on: the earliest criterion that applies to any; by it the best, of equals the newest."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from executive.planning.additive_heuristic import Value
from executive.planning.flaw_orders import Criterion
from executive.planning.ground_formula import Every, GroundCondition, Some
from executive.planning.ground_task import GroundTask
from executive.planning.open_conditions import reusable
from executive.planning.partial_plan import Flaw, OpenCondition, PartialPlan, Threat, step_of
from executive.planning.threats import choices

Key = Callable[[PartialPlan, Flaw], float]  # the smallest is selected


class FlawSelection:
    """One flaw order, ready to choose in the plans of one task."""

    def __init__(self, criteria: tuple[Criterion, ...], task: GroundTask, rng: np.random.Generator) -> None:
        self._task = task
        self._rng = rng
        self._criteria = tuple((criterion, self._key(criterion)) for criterion in criteria)

    def choose(self, plan: PartialPlan) -> Flaw:
        """The flaw of a plan that has one."""
        for criterion, key in self._criteria:
            best: Flaw | None = None
            least = 0.0
            for flaw in self._candidates(plan, criterion):
                if criterion.limit is not None and self.refinements(plan, flaw) > criterion.limit:
                    continue
                value = key(plan, flaw)
                if best is None or value < least or (value == least and criterion.order == "FIFO"):
                    best, least = flaw, value
            if best is not None:
                return best
        raise AssertionError("a flaw order selects every flaw")  # parse_flaw_order sees to it

    # --- which flaws -----------------------------------------------------------------------------
    def _candidates(self, plan: PartialPlan, criterion: Criterion) -> Iterator[Flaw]:
        """The flaws of the criterion's types, threats before open conditions, newest first."""
        types = criterion.types
        if "n" in types or "s" in types:
            threat = plan.threats
            while threat is not None:
                if ("s" if threat.conditions else "n") in types:
                    yield threat
                threat = threat.rest
        if types & {"o", "l", "u", "t"}:
            yield from self._open(plan, types)

    def _open(self, plan: PartialPlan, types: frozenset[str]) -> Iterator[OpenCondition]:
        local = step_of(self._task, plan.open.first) if plan.open else 0
        cell = plan.open
        while cell is not None:
            if (
                "o" in types
                or ("l" in types and step_of(self._task, cell.first) == local)
                or ("u" in types and _unsafe(plan, cell))
            ):  # no ground condition is static: those are folded away
                yield cell
            cell = cell.rest

    def refinements(self, plan: PartialPlan, flaw: Flaw) -> int:
        """The number of ways to mend a flaw."""
        if isinstance(flaw, Threat):
            return choices(plan, flaw)
        condition = flaw.condition
        if not isinstance(condition, int):
            return len(condition.parts) if isinstance(condition, Some) else 1
        old = reusable(plan, flaw).bit_count()
        return len(self._task.achievers[condition]) + old + (condition in self._task.initial)

    # --- which comes first -----------------------------------------------------------------------
    def _key(self, criterion: Criterion) -> Key:
        match criterion.order:
            case "LIFO" | "FIFO":
                return lambda plan, flaw: 0
            case "R":
                return lambda plan, flaw: self._rng.random()
            case "LR":
                return self.refinements
            case "MR":
                return lambda plan, flaw: -self.refinements(plan, flaw)
            case "NEW":
                return lambda plan, flaw: 0 if self._by_new_step(flaw) else 1
            case "REUSE":
                return lambda plan, flaw: 1 if self._by_new_step(flaw) else 0
            case _:
                return self._estimated(criterion)

    def _by_new_step(self, flaw: Flaw) -> bool:
        assert isinstance(flaw, OpenCondition)
        return isinstance(flaw.condition, int) and bool(self._task.achievers[flaw.condition])

    def _estimated(self, criterion: Criterion) -> Key:
        """Least or most cost or work; with makespan, of the time at which the condition can hold."""
        sign = -1 if criterion.order[0] == "M" else 1
        quantity: Callable[[Value], float] = {
            "C": lambda value: value.cost,
            "W": lambda value: value.work,
        }[criterion.order[1]]
        if criterion.heuristic == "makespan":
            quantity = _makespan
        reuse = criterion.heuristic == "addr"

        def key(plan: PartialPlan, flaw: Flaw) -> float:
            assert isinstance(flaw, OpenCondition)
            if reuse and isinstance(flaw.condition, int) and reusable(plan, flaw):
                return sign * (0 if criterion.order[1] == "C" else 1)
            return sign * quantity(self._task.estimates.of(flaw.condition))

        return key


def _makespan(value: Value) -> float:
    return value.makespan


def _unsafe(plan: PartialPlan, flaw: OpenCondition) -> bool:
    """Whether some step may come before the consumer and undo the condition."""
    late, masks = plan.orderings.late, plan.effects.masks()
    return any(masks[literal ^ 1] & ~late[flaw.last] & ~(1 << flaw.first) for literal in _literals(flaw.condition))


def _literals(condition: GroundCondition) -> tuple[int, ...]:
    if isinstance(condition, int):
        return (condition,)
    return tuple(part for part in condition.parts if isinstance(part, int)) if isinstance(condition, Every) else ()
