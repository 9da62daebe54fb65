"""Selects the flaw to resolve: the first criterion that applies to any flaw decides, among equals the newest flaw."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from tailor.executive.planning.flaws.flaw_orders import Criterion
from tailor.executive.planning.ground.additive_heuristic import Value
from tailor.executive.planning.structures.linked_list import cells_of
from tailor.executive.planning.structures.random_source import RandomSource
from tailor.executive.planning.structures.refinable import Refinable

P = TypeVar("P", bound=Refinable)
P_contra = TypeVar("P_contra", bound=Refinable, contravariant=True)
C = TypeVar("C")  # open conditions
T = TypeVar("T")  # threats
C_contra = TypeVar("C_contra", contravariant=True)
T_contra = TypeVar("T_contra", contravariant=True)


class FlawMeasures(Protocol[P_contra, C_contra, T_contra]):
    """Interface of the flaw properties that flaw orders use."""

    def is_separable(self, plan: P_contra, threat: T_contra) -> bool:
        """Whether separation can resolve a threat."""
        ...

    def step(self, condition: C_contra) -> int:
        """Number of the step that a condition belongs to, unique within the plan."""
        ...

    def static(self, condition: C_contra) -> bool:
        """Whether no action changes the condition's predicate."""
        ...

    def is_unsafe(self, plan: P_contra, condition: C_contra) -> bool:
        """Whether some step may come before the consumer and undo the condition."""
        ...

    def count_condition_refinements(self, plan: P_contra, condition: C_contra) -> int:
        """Number of refinements of an open condition."""
        ...

    def count_threat_refinements(self, plan: P_contra, threat: T_contra) -> int:
        """Number of refinements of a threat."""
        ...

    def has_new_achiever(self, plan: P_contra, condition: C_contra) -> bool:
        """Whether a new step can achieve the condition."""
        ...

    def value(self, plan: P_contra, condition: C_contra) -> Value:
        """The additive estimate, without reuse of steps."""
        ...

    def has_old_achiever(self, plan: P_contra, condition: C_contra) -> bool:
        """Whether a step already in the plan may achieve the condition."""
        ...


@dataclass(frozen=True, slots=True)
class _PreparedCriterion(Generic[P, C, T]):
    """A criterion with its key functions and flags, computed once per search."""

    criterion: Criterion
    threat_key: Callable[[P, T], float]
    condition_key: Callable[[P, C], float]
    least: float  # lower bound of all keys
    any_threat: bool  # applies to threats of both kinds, whatever their number of refinements
    no_threat: bool
    no_condition: bool


class FlawSelection(Generic[P, C, T]):
    """One flaw order, prepared for the plans of one search."""

    def __init__(self, criteria: tuple[Criterion, ...], measures: FlawMeasures[P, C, T], rng: RandomSource) -> None:
        self._measures = measures
        self._rng = rng
        self._criteria = tuple(self._prepared(criterion) for criterion in criteria)

    def _prepared(self, criterion: Criterion) -> _PreparedCriterion[P, C, T]:
        types = criterion.types
        return _PreparedCriterion(
            criterion,
            self._threat_key(criterion),
            self._condition_key(criterion),
            0 if criterion.order in ("LIFO", "LR") else -math.inf,
            {"n", "s"} <= types and criterion.limit is None,
            not types & {"n", "s"},
            types <= {"n", "s"},
        )

    def select(self, plan: P) -> C | T:
        """The flaw to resolve next, of a plan with at least one."""
        for prepared in self._criteria:
            threats = [] if prepared.no_threat else self._threats(plan, prepared)
            conditions = [] if prepared.no_condition else self._conditions(plan, prepared.criterion)
            if threats or conditions:
                return self._best(plan, prepared, threats, conditions)
        raise AssertionError("a flaw order selects every flaw")  # parse_flaw_order guarantees it

    def _best(self, plan: P, prepared: _PreparedCriterion[P, C, T], threats: list[T], conditions: list[C]) -> C | T:
        """The flaw with the smallest key, of equals the newest."""
        best: C | T = threats[0] if threats else conditions[0]
        if len(threats) + len(conditions) == 1:
            return best
        if prepared.criterion.order == "FIFO":
            return conditions[-1] if conditions else threats[-1]
        smallest = math.inf
        for threat in threats:
            key = prepared.threat_key(plan, threat)
            if key < smallest:
                best, smallest = threat, key
                if key <= prepared.least:
                    return best
        for condition in conditions:
            key = prepared.condition_key(plan, condition)
            if key < smallest:
                best, smallest = condition, key
        return best

    def _threats(self, plan: P, prepared: _PreparedCriterion[P, C, T]) -> list[T]:
        """The threats that a criterion applies to."""
        threats: list[T] = cells_of(plan.threats)
        if prepared.any_threat or not threats:
            return threats
        measures, types, limit = self._measures, prepared.criterion.types, prepared.criterion.limit
        if not {"n", "s"} <= types:
            threats = [threat for threat in threats if measures.is_separable(plan, threat) == ("s" in types)]
        if limit is not None:
            threats = [threat for threat in threats if measures.count_threat_refinements(plan, threat) <= limit]
        return threats

    def _conditions(self, plan: P, criterion: Criterion) -> list[C]:
        """The open conditions that a criterion applies to."""
        measures, types, limit = self._measures, criterion.types, criterion.limit
        conditions: list[C] = cells_of(plan.open)
        if "o" not in types and conditions:
            local = measures.step(conditions[0]) if "l" in types else None
            if types & {"u", "t"}:
                conditions = [condition for condition in conditions if self._is(plan, condition, types, local)]
            else:
                conditions = [condition for condition in conditions if measures.step(condition) == local]
        if limit is not None:
            conditions = [c for c in conditions if measures.count_condition_refinements(plan, c) <= limit]
        return conditions

    def _is(self, plan: P, condition: C, types: frozenset[str], local: int | None) -> bool:
        """Whether a condition is of one of the types; `local` is the step of the newest one."""
        measures = self._measures
        return (
            (local is not None and measures.step(condition) == local)
            or ("u" in types and measures.is_unsafe(plan, condition))
            or ("t" in types and measures.static(condition))
        )

    # --- keys: the smallest comes first ----------------------------------------------------------
    def _threat_key(self, criterion: Criterion) -> Callable[[P, T], float]:
        count = self._measures.count_threat_refinements
        keys: dict[str, Callable[[P, T], float]] = {
            "LR": count,
            "MR": lambda plan, threat: -count(plan, threat),
            "R": lambda plan, threat: float(self._rng.generator.random()),
        }
        return keys.get(criterion.order, lambda plan, threat: 0)

    def _condition_key(self, criterion: Criterion) -> Callable[[P, C], float]:
        measures = self._measures
        keys: dict[str, Callable[[P, C], float]] = {
            "LIFO": lambda plan, condition: 0,
            "FIFO": lambda plan, condition: 0,
            "R": lambda plan, condition: float(self._rng.generator.random()),
            "LR": measures.count_condition_refinements,
            "MR": lambda plan, condition: -measures.count_condition_refinements(plan, condition),
            "NEW": lambda plan, condition: not measures.has_new_achiever(plan, condition),
            "REUSE": measures.has_new_achiever,
        }
        return keys.get(criterion.order) or self._estimated(criterion)

    def _estimated(self, criterion: Criterion) -> Callable[[P, C], float]:
        """Least or most cost or work; with makespan, the time at which the condition can hold."""
        measures, sign = self._measures, -1 if criterion.order[0] == "M" else 1
        field = {"C": 0, "W": 1}[criterion.order[1]] if criterion.heuristic != "makespan" else 2
        reuse = criterion.heuristic == "addr"

        def key(plan: P, condition: C) -> float:
            if reuse and measures.has_old_achiever(plan, condition):
                return sign * field  # no cost, one unit of work
            return sign * measures.value(plan, condition)[field]

        return key
