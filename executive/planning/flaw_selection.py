"""Chooses the flaw to work on: the earliest criterion that applies to any; by it the best, of equals the newest."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Generic, Protocol, TypeVar

import numpy as np

from executive.planning.additive_heuristic import Value
from executive.planning.flaw_orders import Criterion

P = TypeVar("P")
P_contra = TypeVar("P_contra", contravariant=True)
C = TypeVar("C")  # open conditions
T = TypeVar("T")  # threats


class FlawMeasures(Protocol[P_contra, C, T]):
    """What flaw orders ask about the flaws of a plan; lists of flaws begin with the newest."""

    def conditions(self, plan: P_contra) -> Iterator[C]:
        """The open conditions."""
        ...

    def threats(self, plan: P_contra) -> Iterator[T]:
        """The threats."""
        ...

    def separable(self, plan: P_contra, threat: T) -> bool:
        """Whether separation may mend a threat."""
        ...

    def step(self, condition: C) -> int:
        """The step that a condition belongs to."""
        ...

    def static(self, condition: C) -> bool:
        """Whether no action touches the condition's predicate."""
        ...

    def unsafe(self, plan: P_contra, condition: C) -> bool:
        """Whether some step may come before the consumer and undo the condition."""
        ...

    def condition_choices(self, plan: P_contra, condition: C) -> int:
        """The number of ways to achieve a condition."""
        ...

    def threat_choices(self, plan: P_contra, threat: T) -> int:
        """The number of ways to mend a threat."""
        ...

    def by_new_step(self, plan: P_contra, condition: C) -> bool:
        """Whether a new step can achieve the condition."""
        ...

    def value(self, plan: P_contra, condition: C) -> Value:
        """The heuristic's estimate without reuse of steps."""
        ...

    def provided(self, plan: P_contra, condition: C) -> bool:
        """Whether a step of the plan may already achieve the condition."""
        ...


class FlawSelection(Generic[P, C, T]):
    """One flaw order, ready to choose in the plans of one search."""

    def __init__(
        self, criteria: tuple[Criterion, ...], measures: FlawMeasures[P, C, T], rng: np.random.Generator
    ) -> None:
        self._measures = measures
        self._rng = rng
        self._criteria = tuple((c, self._threat_key(c), self._condition_key(c)) for c in criteria)

    def choose(self, plan: P) -> C | T:
        """The flaw of a plan that has one."""
        for criterion, threat_key, condition_key in self._criteria:
            best: list[C | T] = []
            least = 0.0
            for flaw, value in self._valued(plan, criterion, threat_key, condition_key):
                if not best or value < least or (value == least and criterion.order == "FIFO"):
                    best, least = [flaw], value
            if best:
                return best[0]
        raise AssertionError("a flaw order selects every flaw")  # parse_flaw_order sees to it

    def _valued(
        self,
        plan: P,
        criterion: Criterion,
        threat_key: Callable[[P, T], float],
        condition_key: Callable[[P, C], float],
    ) -> Iterator[tuple[C | T, float]]:
        """The flaws that a criterion applies to, threats first, with what orders them."""
        measures, types, limit = self._measures, criterion.types, criterion.limit
        if "n" in types or "s" in types:
            both = "n" in types and "s" in types
            for threat in measures.threats(plan):
                if (both or ("s" in types) == measures.separable(plan, threat)) and (
                    limit is None or measures.threat_choices(plan, threat) <= limit
                ):
                    yield threat, threat_key(plan, threat)
        if not types <= {"n", "s"}:
            for condition in self._conditions(plan, types):
                if limit is None or measures.condition_choices(plan, condition) <= limit:
                    yield condition, condition_key(plan, condition)

    def _conditions(self, plan: P, types: frozenset[str]) -> Iterator[C]:
        measures = self._measures
        local = None
        for condition in measures.conditions(plan):
            step = measures.step(condition)
            local = step if local is None else local  # the first is the newest
            if (
                "o" in types
                or ("l" in types and step == local)
                or ("u" in types and measures.unsafe(plan, condition))
                or ("t" in types and measures.static(condition))
            ):
                yield condition

    # --- which comes first: the smallest key -----------------------------------------------------
    def _threat_key(self, criterion: Criterion) -> Callable[[P, T], float]:
        choices = self._measures.threat_choices
        keys: dict[str, Callable[[P, T], float]] = {
            "LR": choices,
            "MR": lambda plan, threat: -choices(plan, threat),
            "R": lambda plan, threat: float(self._rng.random()),
        }
        return keys.get(criterion.order, lambda plan, threat: 0)

    def _condition_key(self, criterion: Criterion) -> Callable[[P, C], float]:
        measures = self._measures
        keys: dict[str, Callable[[P, C], float]] = {
            "LIFO": lambda plan, condition: 0,
            "FIFO": lambda plan, condition: 0,
            "R": lambda plan, condition: float(self._rng.random()),
            "LR": measures.condition_choices,
            "MR": lambda plan, condition: -measures.condition_choices(plan, condition),
            "NEW": lambda plan, condition: not measures.by_new_step(plan, condition),
            "REUSE": measures.by_new_step,
        }
        return keys.get(criterion.order) or self._estimated(criterion)

    def _estimated(self, criterion: Criterion) -> Callable[[P, C], float]:
        """Least or most cost or work; with makespan, the time at which the condition can hold."""
        measures, sign = self._measures, -1 if criterion.order[0] == "M" else 1
        field = {"C": 0, "W": 1}[criterion.order[1]] if criterion.heuristic != "makespan" else 2
        reuse = criterion.heuristic == "addr"

        def key(plan: P, condition: C) -> float:
            if reuse and measures.provided(plan, condition):
                return sign * field  # no cost, one unit of work
            return sign * measures.value(plan, condition)[field]

        return key
