"""Why a subgoal was chosen: what the models predict for its alternatives, and what greedy would have done (Figure 11).

Made from a recorded `Subgoals` message and the action models alone; nothing is executed again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.action_context import ContextRows
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.alternatives import Alternatives, alternatives
from tailor.executive.refinement.greedy import greedy
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction, Variable
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas import messages as m
from tailor.tools.viewer.explanations.situation import Situation, situations_of

MAX_ID = 4096  # of a variable; a message has no room for as many


@dataclass(frozen=True, slots=True)
class FreeParameter:
    """A free parameter: what was chosen, what greedy chooses, and the predictions over its range, the others as chosen.

    `touched` are the places of the actions that depend on it, among those within the horizon.
    """

    variable: Variable
    chosen: float
    greedy: float
    alternatives: Alternatives
    touched: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Explanation:
    """A choice against its alternatives. Durations are predicted means; `cost` is the objective, +inf is INVALID."""

    actions: tuple[str, ...]  # within the horizon, in order
    chosen_s: tuple[float, ...]
    greedy_s: tuple[float, ...]
    chosen_cost: float
    greedy_cost: float
    parameters: tuple[FreeParameter, ...]  # the free ones
    situations: tuple[Situation, ...] = ()  # one for each action, where its model says what it sees
    chosen_j: tuple[float, ...] = ()  # predicted energies, where energy is weighed
    greedy_j: tuple[float, ...] = ()


def explain(
    message: m.Subgoals,
    library: Mapping[str, Action],
    models: Models,
    settings: RefinementSettings,
    rng: np.random.Generator,
    objects: m.Contexts | None = None,
) -> Explanation | None:
    """The explanation of a decision; None when nothing was free to choose, or an action is not in the library.

    The greedy choice is searched anew with the executive's own solver, from `rng`. `objects` are those of the decision
    if they were published in the same tick.
    """
    sequence = sequence_of(message, library, objects)
    if sequence is None or message.horizon < 1:
        return None
    settings = replace(settings, horizon=min(message.horizon, len(sequence.actions)))
    chosen = chosen_values(message)
    sequence = accepted(sequence, chosen, models, settings)
    objective = _objective(sequence, models, settings)
    if not objective.ids:
        return None
    alone = greedy(sequence, models, settings, rng).values
    picked, lone = both = objective.vectors([chosen, alone])
    predictions = objective.predict(both)
    chosen_s, greedy_s = np.transpose([prediction.duration_s for prediction in predictions]).tolist()
    chosen_j, greedy_j = np.transpose([prediction.energy_j for prediction in predictions]).tolist()
    chosen_cost, greedy_cost = objective.total(predictions).tolist()
    return Explanation(
        tuple(a.action.name for a in sequence.within(settings.horizon)),
        tuple(chosen_s),
        tuple(greedy_s),
        chosen_cost,
        greedy_cost,
        _parameters(sequence, objective, picked, lone),
        situations_of(sequence.within(settings.horizon), sequence.bind(chosen), sequence.bind(alone), models),
        tuple(chosen_j) if settings.energy_weight else (),
        tuple(greedy_j) if settings.energy_weight else (),
    )


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
    unused = Variable(
        0, "", "", "", 0.0, 0.0, False, 0.0
    )  # ids have gaps where an asserted subgoal replaced a variable
    variables = tuple(table.get(i, replace(unused, id=i)) for i in range(max(table) + 1))
    contexts = _rows_by_action(objects) if objects is not None and objects.tick == message.tick else {}
    actions = tuple(
        InstantiatedAction(
            library[a.action],
            a.step,
            tuple(p.id for p in a.parameters),
            a.asserted,
            context=contexts.get(a.action, ()),
        )
        for a in message.actions
    )
    return ActionSequence(actions, variables, library, contexts=contexts)


def _fits(instance: m.InstantiatedAction, library: Mapping[str, Action]) -> bool:
    """Whether an action is known and has its parameters; a damaged message has anything."""
    ids = [parameter.id for parameter in instance.parameters]
    known = instance.action in library and len(ids) == len(library[instance.action].parameters)
    return known and all(0 <= each <= MAX_ID for each in ids)


def _rows_by_action(objects: m.Contexts) -> dict[str, ContextRows]:
    """Rows of the objects near each action, by its name."""
    return {each.action: each.rows for each in objects.contexts if each.columns}


def _objective(sequence: ActionSequence, models: Models, settings: RefinementSettings) -> SequenceObjective:
    return SequenceObjective(sequence.within(settings.horizon), sequence.variables, models, settings)


def chosen_values(message: m.Subgoals) -> dict[int, float]:
    """The values that were chosen for the free parameters, by variable id."""
    return {p.id: p.value for a in message.actions for p in a.parameters if not p.bound}


def accepted(
    sequence: ActionSequence, chosen: Mapping[int, float], models: Models, settings: RefinementSettings
) -> ActionSequence:
    """The sequence with every risk allowed if the choice needs it: risks that were accepted are not in the message."""
    objective = _objective(sequence, models, settings)
    if np.isfinite(objective(objective.vector(chosen)[None]))[0]:
        return sequence
    return replace(sequence, actions=tuple(replace(action, risk=1.0) for action in sequence.actions))


def _parameters(
    sequence: ActionSequence, objective: SequenceObjective, picked: Array, lone: Array
) -> tuple[FreeParameter, ...]:
    return tuple(
        FreeParameter(
            sequence.variables[along.variable],
            float(picked[place]),
            float(lone[place]),
            along,
            tuple(i for i, stage in enumerate(objective.stages) if place in stage.columns),
        )
        for place, along in enumerate(alternatives(objective, picked))
    )
