"""Shortcut of a running course: the subgoal that it leads to is dropped as soon as it is no longer worth its time.

A subgoal is chosen before the robot starts, for a robot at rest that faces somewhere else. Once the robot has turned,
or has passed the object, the way from where it is may be as safe without the rest of the subgoal, and shorter.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.subgoal_comparison import with_any_risk
from tailor.executive.refinement.course_check import from_here
from tailor.executive.refinement.objective.choice import Choice, any_of, choice_of
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.rolling_start import rolled_on

MIN_GAIN_S = 0.3  # of the shortcut: less is within the errors of the models, and the robot would turn for it


def shortcut(
    decided: ActionSequence,
    choice: Choice,
    now: ActionSequence,
    models: Models,
    settings: RefinementSettings,
) -> tuple[ActionSequence, Choice] | None:
    """The course without its first subgoal, from the state of now, and the choice for it; None if it is not better.

    It is better if the expected cost, failures priced, is lower by `MIN_GAIN_S` than that of the course as decided, and
    it is safe: no action is likelier to fail than `p_fail_max`, or all together are no likelier to than those of the
    course as decided, neither as predicted then nor now. A robot that is faster than its drives may begin has to be as
    safe from where it rolls on to.

    Args:
      decided: Sequence whose first action leads to an asserted subgoal, and runs.
      choice: Its chosen values, and the probabilities of failure that were accepted with them.
      now: The plan instantiated from the belief of now.
      models: Loaded models.
      settings: Horizon, limit and prices.
    """
    values = choice.values
    straight = from_here(replace(decided, actions=decided.actions[1:]), now)
    short = _predicted(straight.bind(values), models, settings)
    long = _predicted(from_here(decided.bind(values), now), models, settings)
    accepted = min(any_of(choice.failure), any_of(long.failure))
    if not short.total_s + MIN_GAIN_S < long.total_s or not _is_safe(short, accepted, settings):
        return None
    rolled = rolled_on(straight)
    if rolled is not None and not _is_safe(_predicted(rolled.bind(values), models, settings), accepted, settings):
        return None
    return straight, replace(short, values=dict(values))


def _is_safe(course: Choice, accepted: float, settings: RefinementSettings) -> bool:
    """Whether each action is within the limit, or all together within the accepted probability; False for NaN."""
    within = all(probability <= settings.p_fail_max for probability in course.failure)
    return within or any_of(course.failure) <= accepted


def _predicted(course: ActionSequence, models: Models, settings: RefinementSettings) -> Choice:
    """Predictions for a bound course, whatever its risk."""
    course = with_any_risk(course)
    return choice_of(
        SequenceObjective(course.within(settings.horizon), course.variables, models, settings), np.empty(0)
    )
