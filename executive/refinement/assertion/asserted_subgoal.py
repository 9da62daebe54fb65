"""Asserted subgoal: an action inserted before another one, with a free goal from which the other one then starts.

The index of the PDDL argument (Algorithm 2, line 8) determines the state that a parameter belongs to: the first
argument with parameters is the start state of the action, the last one its goal state.
"""

from __future__ import annotations

from dataclasses import replace

from tailor.executive.interfaces.action import Action, Parameter
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction, Variable


def with_subgoal(sequence: ActionSequence, position: int) -> ActionSequence:
    """The sequence with the subgoal action of the action at `position` inserted before it (Algorithm 3, lines 16-20).

    The subgoal action starts where the action started. Its goal, the asserted subgoal, is a new label whose parameters
    are all free in their default ranges; the action starts from there. A risk that was accepted without the subgoal no
    longer is: the settings' limit applies.

    Raises:
      KeyError: The subgoal action is not in the library, or needs a quantity that the action's start does not have.
    """
    action = sequence.actions[position]
    subgoal_action = sequence.library[action.action.subgoal_action]
    start = start_ids(action)
    subgoal = _free_subgoal(subgoal_action, len(sequence.variables))
    subgoal_ids = {variable.quantity: variable.id for variable in subgoal}
    goal_side = set(goal_indices(subgoal_action))
    before = tuple(
        subgoal_ids[parameter.quantity] if j in goal_side else start[parameter.quantity]
        for j, parameter in enumerate(subgoal_action.parameters)
    )
    moved = {start[quantity]: identifier for quantity, identifier in subgoal_ids.items() if quantity in start}
    start_side = set(start_indices(action.action))
    after = tuple(moved.get(i, i) if j in start_side else i for j, i in enumerate(action.variables))
    context = sequence.contexts.get(subgoal_action.name, ())
    to_subgoal = InstantiatedAction(subgoal_action, action.step, before, asserted=True, context=context)
    pair = to_subgoal, replace(action, variables=after, risk=None)
    actions = (*sequence.actions[:position], *pair, *sequence.actions[position + 1 :])
    return replace(sequence, actions=actions, variables=(*sequence.variables, *subgoal))


def start_indices(action: Action) -> tuple[int, ...]:
    """Indices of the parameters that describe the start state of the action."""
    first = min(parameter.argument for parameter in action.parameters)
    return tuple(j for j, parameter in enumerate(action.parameters) if parameter.argument == first)


def goal_indices(action: Action) -> tuple[int, ...]:
    """Indices of the parameters that describe the goal state of the action."""
    last = max(parameter.argument for parameter in action.parameters)
    return tuple(j for j, parameter in enumerate(action.parameters) if parameter.argument == last)


def start_ids(instance: InstantiatedAction) -> dict[str, int]:
    """Variable ids of the action's start state, by quantity."""
    return {instance.action.parameters[j].quantity: instance.variables[j] for j in start_indices(instance.action)}


def _free_subgoal(subgoal_action: Action, first_id: int) -> tuple[Variable, ...]:
    """New free variables for the goal state of the subgoal action."""
    subgoal: list[Variable] = []
    for j in goal_indices(subgoal_action):
        subgoal.append(_free(subgoal_action.parameters[j], first_id + len(subgoal), f"subgoal{first_id}"))
    return tuple(subgoal)


def _free(parameter: Parameter, identifier: int, label: str) -> Variable:
    """Free variable in the parameter's default range."""
    kind = (parameter.quantity, parameter.unit, parameter.lower, parameter.upper, parameter.periodic)
    return Variable(identifier, label, *kind, value=None)
