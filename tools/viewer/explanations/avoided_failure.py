"""Why a subgoal was asserted: what the models predict for the action after it with and without it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.refinement.assertion.subgoal_comparison import with_any_risk
from tailor.executive.refinement.course_check import from_here
from tailor.executive.refinement.objective.choice import any_of, choice_of
from tailor.tools.viewer.explanations.decided_sequence import Decided, objective_of


@dataclass(frozen=True, slots=True)
class AvoidedFailure:
    """Predicted probabilities of failure of an action, straight to its goal and by way of the subgoals before it."""

    action: str
    straight: float
    by_subgoal: float  # that the way to a subgoal or the action fails


def avoided_failure(decided: Decided) -> AvoidedFailure | None:
    """Failure that the asserted subgoals at the start of a sequence avoid; None if it begins with none."""
    unit = decided.sequence.units()[0]
    if not unit[0].asserted or unit[-1].asserted:
        return None
    bound = with_any_risk(decided.sequence.bind(decided.chosen))
    ways = (from_here(replace(bound, actions=unit[-1:]), bound), replace(bound, actions=unit))
    choices = (choice_of(objective_of(way, decided.models, decided.settings), np.empty(0)) for way in ways)
    straight, by_subgoal = (any_of(choice.failure) for choice in choices)
    return AvoidedFailure(unit[-1].action.name, straight, by_subgoal)
