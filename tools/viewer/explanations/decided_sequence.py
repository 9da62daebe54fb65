"""The decision of a recorded message, rebuilt so that the models can judge it again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.action_context import ContextRows
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas import messages as m

MAX_ID = 4096  # of a variable; a message has no room for as many


@dataclass(frozen=True, slots=True)
class Decided:
    """A decision: its sequence, the values chosen for the free parameters by variable id, and what judges them.

    Where the choice needs it, the sequence allows every risk: risks that were accepted are not in the message.
    """

    sequence: ActionSequence
    chosen: Mapping[int, float]
    models: Models
    settings: RefinementSettings  # with the horizon of the decision
    objective: SequenceObjective


def decided(
    message: m.Subgoals,
    library: Mapping[str, Action],
    models: Models,
    settings: RefinementSettings,
    objects: m.Contexts | None = None,
) -> Decided | None:
    """The decision that the message reports; None if it does not fit the actions of the library.

    `objects` are those of the decision if they were published in the same tick.
    """
    sequence = sequence_of(message, library, objects)
    if sequence is None or message.horizon < 1:
        return None
    settings = replace(settings, horizon=min(message.horizon, len(sequence.actions)))
    chosen, objective = chosen_values(message), objective_of(sequence, models, settings)
    if not np.isfinite(objective(objective.vector(chosen)[None]))[0]:
        sequence = replace(sequence, actions=tuple(replace(action, risk=1.0) for action in sequence.actions))
        objective = objective_of(sequence, models, settings)
    return Decided(sequence, chosen, models, settings, objective)


def sequence_of(
    message: m.Subgoals, library: Mapping[str, Action], objects: m.Contexts | None = None
) -> ActionSequence | None:
    """The instantiated sequence that the message reports; None if it does not fit the actions of the library."""
    if not message.actions or not all(_fits(a, library) for a in message.actions):
        return None
    table: dict[int, Variable] = {}
    for instance in message.actions:
        for declared, parameter in zip(library[instance.action].parameters, instance.parameters, strict=True):
            wide = parameter.upper - parameter.lower >= declared.upper - declared.lower
            table[parameter.id] = Variable(
                parameter.id,
                parameter.label,
                declared.quantity,
                declared.unit,
                parameter.lower,
                parameter.upper,
                declared.periodic and wide,
                parameter.value if parameter.bound else None,
            )
    # ids have gaps where an asserted subgoal replaced a variable
    unused = Variable(0, "", "", "", 0.0, 0.0, False, 0.0)
    variables = tuple(table.get(i, replace(unused, id=i)) for i in range(max(table) + 1))
    contexts = _rows_by_action(objects) if objects is not None and objects.tick == message.tick else {}
    actions = tuple(
        InstantiatedAction(
            library[a.action], a.step, tuple(p.id for p in a.parameters), a.asserted, context=contexts.get(a.action, ())
        )
        for a in message.actions
    )
    return ActionSequence(actions, variables, library, contexts=contexts)


def chosen_values(message: m.Subgoals) -> dict[int, float]:
    """The values that were chosen for the free parameters, by variable id."""
    return {p.id: p.value for a in message.actions for p in a.parameters if not p.bound}


def objective_of(sequence: ActionSequence, models: Models, settings: RefinementSettings) -> SequenceObjective:
    """The objective of the actions within the horizon."""
    return SequenceObjective(sequence.within(settings.horizon), sequence.variables, models, settings)


def _fits(instance: m.InstantiatedAction, library: Mapping[str, Action]) -> bool:
    """Whether an action is known and has its parameters; a damaged message has anything."""
    ids = [parameter.id for parameter in instance.parameters]
    known = instance.action in library and len(ids) == len(library[instance.action].parameters)
    return known and all(0 <= each <= MAX_ID for each in ids)


def _rows_by_action(objects: m.Contexts) -> dict[str, ContextRows]:
    """Rows of the objects near each action, by its name."""
    return {each.action: each.rows for each in objects.contexts if each.columns}
