"""Conditional effects of a finished plan: those whose truth no order of its events may alter, and no further step."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld
from tailor.executive.planning.ground_plans.mentions import Choices, atoms_of, by_predicate, mentioned, terms_of
from tailor.executive.planning.pddl.formula_size import parts_of
from tailor.executive.planning.pddl.language import Atom, Condition, Formula
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
        """Whether a condition that is read at a node holds, also if there were more steps.

        None if that may depend on times or on more steps, or takes long to tell. A condition that does not hold may do
        so after more steps: these then have to keep more events apart, not fewer.
        """
        formula, late, world = condition.formula, self._late[node], self._world
        self._left -= parts_of(formula, world.choices, self._left) if self._left > 0 else 0
        if self._left <= 0:
            return None
        if any(self._nodes[fact] & ~late for fact in mentioned(formula, terms_of(binding), self._changed, world)):
            return None
        is_true = holds(formula, binding, self._objects.initial, self._objects)
        return None if is_true and self._may_change(formula, binding) else is_true

    def _may_change(self, formula: Formula, binding: Binding) -> bool:
        """Whether some action changes a fact that a formula reads: a step without use for the goal may end it."""
        atoms = atoms_of(formula, terms_of(binding), self._world)
        return any(
            positive != self._is_initial(atom, read) and all(map(_overlap, read, made))
            for atom, read in atoms
            for positive, made in self._effects.get(atom.predicate, ())
        )

    def _is_initial(self, atom: Atom, choices: Choices) -> bool | None:
        """Whether an atom holds initially; None if it stands for several facts."""
        if any(len(objects) != 1 for objects in choices):
            return None
        return (atom.predicate, *(name for (name,) in choices)) in self._objects.initial

    @cached_property
    def _effects(self) -> Mapping[str, Sequence[tuple[bool, Choices]]]:
        """By predicate the effects of all actions: the sign, and the objects that each term may stand for."""
        effects: dict[str, list[tuple[bool, Choices]]] = {}
        for action in self._world.domain.actions:
            for effect in action.effects:
                terms = {v.name: self._world.choices(v) for v in (*action.parameters, *effect.variables)}
                made = [terms.get(term, (term,)) for term in effect.atom.terms]
                effects.setdefault(effect.atom.predicate, []).append((effect.positive, made))
        return effects


def _overlap(some: Sequence[str], others: Sequence[str]) -> bool:
    """Whether two terms may stand for the same object; True for two variables with several objects each."""
    if len(some) == 1:
        return some[0] in others
    return others[0] in some if len(others) == 1 else bool(some and others)
