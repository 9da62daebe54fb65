"""The detour of subgoal assertion: an action put before another, with a free goal where the other one then starts.

Which parameters belong to the state that an action starts from, and which to the one it leads to, is told by the
index of the PDDL argument (Algorithm 2, line 8): the first argument that has parameters is "from", the last "to".
"""

from __future__ import annotations

from dataclasses import replace

from tailor.executive.interfaces.action import Action, Parameter
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction, Variable


def with_subgoal(sequence: ActionSequence, position: int) -> ActionSequence:
    """The sequence with the detour that the action at `position` names put before it (Algorithm 3, lines 16 to 20).

    The detour starts where the action started; its goal is a new label whose parameters are all free, in the default
    ranges; the action starts from there.

    Raises:
      KeyError: The detour is not in the library, or asks for a quantity that the action's start does not have.
    """
    late = sequence.actions[position]
    subgoal_action = sequence.library[late.action.subgoal_action]
    start = _by_quantity(late, places_from(late.action))
    goal = _free_goal(subgoal_action, len(sequence.variables))
    ends = {variable.quantity: variable.id for variable in goal}
    reached = set(places_to(subgoal_action))
    early = tuple(
        ends[parameter.quantity] if j in reached else start[parameter.quantity]
        for j, parameter in enumerate(subgoal_action.parameters)
    )
    moved = {start[quantity]: identifier for quantity, identifier in ends.items() if quantity in start}
    left = set(places_from(late.action))
    rest = tuple(moved.get(i, i) if j in left else i for j, i in enumerate(late.variables))
    pair = InstantiatedAction(subgoal_action, late.step, early, asserted=True), replace(late, variables=rest)
    actions = (*sequence.actions[:position], *pair, *sequence.actions[position + 1 :])
    return replace(sequence, actions=actions, variables=(*sequence.variables, *goal))


def places_from(action: Action) -> tuple[int, ...]:
    """Which parameters describe the state that the action starts from."""
    first = min(parameter.argument for parameter in action.parameters)
    return tuple(j for j, parameter in enumerate(action.parameters) if parameter.argument == first)


def places_to(action: Action) -> tuple[int, ...]:
    """Which parameters describe the state that the action leads to."""
    last = max(parameter.argument for parameter in action.parameters)
    return tuple(j for j, parameter in enumerate(action.parameters) if parameter.argument == last)


def _by_quantity(instance: InstantiatedAction, places: tuple[int, ...]) -> dict[str, int]:
    """Variable ids by quantity."""
    return {instance.action.parameters[j].quantity: instance.variables[j] for j in places}


def _free_goal(subgoal_action: Action, first_id: int) -> tuple[Variable, ...]:
    """New free variables for the state that the detour leads to."""
    goal: list[Variable] = []
    for j in places_to(subgoal_action):
        goal.append(_free(subgoal_action.parameters[j], first_id + len(goal), f"subgoal{first_id}"))
    return tuple(goal)


def _free(parameter: Parameter, identifier: int, label: str) -> Variable:
    """A variable that may be anything in the parameter's default range."""
    kind = (parameter.quantity, parameter.unit, parameter.lower, parameter.upper, parameter.periodic)
    return Variable(identifier, label, *kind, value=None)
