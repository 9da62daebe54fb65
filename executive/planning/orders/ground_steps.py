"""The steps of a plan without durations, as ground actions that change states."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.language import Action, Effect, Literal
from tailor.executive.planning.plans.plan import Plan, Step
from tailor.executive.planning.plans.portions import completed_work
from tailor.executive.planning.semantics.action_effects import affected
from tailor.executive.planning.semantics.regression import NotClassical, conjunction
from tailor.executive.planning.semantics.state import Binding, Objects, State, holds


@dataclass(frozen=True, slots=True)
class GroundStep:
    """A step with the schema and binding of its action."""

    step: Step
    action: Action
    binding: Binding

    def __str__(self) -> str:
        return f"step {self.step.id}: {format_atom(self.step.action)}"

    def applicable(self, state: State, objects: Objects) -> bool:
        """Whether all conditions hold in a state."""
        return all(holds(condition.formula, self.binding, state, objects) for condition in self.action.conditions)

    def applied(self, state: State, objects: Objects) -> State:
        """The state after the step; its add effects win over its delete effects."""
        added: set[Fact] = set()
        removed: set[Fact] = set()
        for effect in self.action.effects:
            (added if effect.positive else removed).update(self._affected(effect, state, objects))
        return (state - removed) | added

    def conditions(self) -> list[Literal | None]:
        """The literals of the conditions, None for one that is false.

        Raises:
          NotClassical: Some condition is no conjunction of literals.
        """
        formulas = (condition.formula for condition in self.action.conditions)
        return [literal for formula in formulas for literal in conjunction(formula, self.binding)]

    def effects(self, objects: Objects) -> Iterable[Literal]:
        """The literals that the step makes true.

        Raises:
          NotClassical: Some effect has a condition.
        """
        if any(effect.condition for effect in self.action.effects):
            raise NotClassical
        made: dict[Fact, bool] = {}
        for effect in sorted(self.action.effects, key=lambda effect: effect.positive):  # add effects win
            made.update((fact, effect.positive) for fact in self._affected(effect, objects.initial, objects))
        return [Literal(fact, positive) for fact, positive in made.items()]

    def _affected(self, effect: Effect, state: State, objects: Objects) -> list[Fact]:
        return completed_work(affected(effect, self.binding, state, objects))


def predecessors(plan: Plan) -> list[int] | None:
    """For each step of a plan the mask of all steps before it, by position; None if the orderings contain a cycle."""
    position = {step.id: n for n, step in enumerate(plan.steps)}
    before = [0] * len(position)
    for first, then in plan.orderings:
        if first in position and then in position:  # the initial state and the goal need no ordering
            before[position[then]] |= 1 << position[first]
    for middle in range(len(before)):
        before = [mask | before[middle] if mask >> middle & 1 else mask for mask in before]
    return None if any(mask >> n & 1 for n, mask in enumerate(before)) else before
