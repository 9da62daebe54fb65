"""Conditional effects of a finished plan: those whose truth no order of its events may alter."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld
from tailor.executive.planning.ground_plans.mentions import by_predicate, mentioned, terms_of
from tailor.executive.planning.pddl.formula_size import parts_of
from tailor.executive.planning.pddl.language import Condition
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.semantics.state import Objects, holds
from tailor.executive.planning.structures.orderings import FIRST

MAX_PARTS = 4096  # of the conditions of one plan that are evaluated: some milliseconds; "forall" may make thousands


class Guards:
    """Tells whether conditions of effects hold, where no event before changes what they read."""

    def __init__(
        self, changes: Sequence[Iterable[Fact]], late: tuple[int, ...], problem: Problem, world: StaticWorld
    ) -> None:
        """Takes what may change at each node from FIRST on, and the orderings' masks of the nodes not before it."""
        self._late = late
        self._problem = problem
        self._world = world
        self._left = MAX_PARTS
        self._nodes: dict[Fact, int] = {}  # masks of the nodes at which a fact may change
        for node, facts in enumerate(changes, FIRST):
            for fact in facts:
                self._nodes[fact] = self._nodes.get(fact, 0) | 1 << node
        self._changed = by_predicate(self._nodes)

    @cached_property
    def _objects(self) -> Objects:
        return Objects(self._problem)

    def holds(self, condition: Condition, binding: Binding, node: int) -> bool | None:
        """Whether a condition that is read at a node holds; None if that may depend on times, or takes long to tell."""
        formula, late, world = condition.formula, self._late[node], self._world
        self._left -= parts_of(formula, world.choices, self._left) if self._left > 0 else 0
        if self._left <= 0:
            return None
        if any(self._nodes[fact] & ~late for fact in mentioned(formula, terms_of(binding), self._changed, world)):
            return None
        return holds(formula, binding, self._objects.initial, self._objects)
