"""The steps of a plan without durations, as ground actions that change states."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.language import Action, Literal
from tailor.executive.planning.plans.plan import Plan, Step
from tailor.executive.planning.plans.portions import completed_work
from tailor.executive.planning.semantics.action_effects import affected, state_after
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
        """The state after the step."""
        return state_after(self.action, self.binding, state, objects)

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
            facts = completed_work(affected(effect, self.binding, objects.initial, objects))
            made.update(dict.fromkeys(facts, effect.positive))
        return [Literal(fact, positive) for fact, positive in made.items()]


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
