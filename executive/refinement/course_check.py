"""Check of a running course: how likely it fails from here, among the objects that are believed now.

A believed object moves with every percept. A course that is as likely to succeed as when it was decided is kept: each
new search may lead around the other side, and time is lost in turning.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.asserted_subgoal import start_ids
from tailor.executive.refinement.objective.choice import any_of
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings

MAX_RISE = 0.05  # of the predicted probability of failure since the decision


def risen_failure(
    decided: ActionSequence,
    values: Mapping[int, float],
    failure: Sequence[float],
    now: ActionSequence,
    models: Models,
    settings: RefinementSettings,
) -> tuple[float, bool]:
    """Expected price of the running action's failures, s, and whether the course has clearly become likelier to fail.

    Later actions count for the second only: they are decided anew when this one ends, and are no reason to stop it.

    Args:
      decided: Sequence whose first action runs.
      values: Chosen values by variable id.
      failure: Predicted probability of failure of each action within the horizon, when it was decided.
      now: The plan instantiated from the belief of now.
      models: Loaded models.
      settings: Horizon, spread of arrivals and prices.
    """
    course = from_here(decided.bind(values), now)
    objective = SequenceObjective(course.within(settings.horizon), course.variables, models, settings)
    predictions = objective.predict(np.empty(0))
    risen = any_of([float(prediction.failure[0]) for prediction in predictions]) > any_of(failure) + MAX_RISE
    return float(predictions[0].failure_s[0]), risen


def from_here(course: ActionSequence, now: ActionSequence) -> ActionSequence:
    """A bound course whose first action starts from the state of now, and whose objects are those of now."""
    believed = {quantity: now.variables[i].value for quantity, i in start_ids(now.actions[0]).items()}
    variables = list(course.variables)
    for quantity, i in start_ids(course.actions[0]).items():
        if (value := believed.get(quantity)) is not None:
            variables[i] = variables[i].bound_to(value)
    actions = tuple(
        replace(each, context=now.contexts.get(each.action.name, ())) if each.action.context else each
        for each in course.actions
    )
    return replace(course, actions=actions, variables=tuple(variables))
