"""The refinement gate (paper 6.3.2): a learned tree compares the greedy and the refined choice and may keep the former.

"The learned decision tree is essentially an action model too: it predicts the outcome of applying action models to
actions." Its inputs are independent of the robot: the predictions for both choices, and the distance between them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.models import RefinementGate
from tailor.executive.refinement.objective.choice import Choice
from tailor.executive.refinement.objective.sequence import ActionSequence, Variable
from tailor.schemas.errors import UsageError

# Inputs of the tree, in this order; training takes them from the telemetry, so they are computed only here. The names
# are those in the cards of the models that ship ("detours": asserted subgoals), so they stay. "First" is the next
# action with its asserted subgoals, "rest" the actions after it within the horizon; times are predicted means.
SITUATION = (
    "gain_s",  # objective, greedy minus refined
    "gain_pct",  # gain relative to greedy's objective
    "price_s",  # first, refined minus greedy
    "first_s",  # greedy's
    "rest_s",  # greedy's
    "return_s",  # rest, greedy minus refined
    "spread_s",  # standard deviation summed over the actions, refined minus greedy
    "failure",  # maximum predicted probability, refined
    "failure_more",  # the same, refined minus greedy
    "turned_rad",  # maximum angle between the two choices
    "moved",  # maximum difference of all other values, as a share of the range
    "detours",  # number of asserted subgoals before the first action
)
NO_PREDICTION = -1.0


@dataclass(frozen=True, slots=True)
class Verdict:
    """Inputs and prediction of the tree; empty if there was nothing to compare."""

    situation: tuple[float, ...] = ()  # by SITUATION
    p_slowdown: float = NO_PREDICTION  # probability that refinement costs time, 0..1
    keep_greedy: bool = False


def check_gate(model: RefinementGate) -> RefinementGate:
    """The model, if its inputs are those computed here.

    Raises:
      UsageError: The inputs differ.
    """
    if model.input_names != SITUATION:
        raise UsageError(
            f"the refinement gate has the inputs {', '.join(model.input_names)}, expected {', '.join(SITUATION)}: "
            "train it again with `tailor train-gate`"
        )
    return model


def judge(sequence: ActionSequence, greedy: Choice, refined: Choice, model: RefinementGate | None) -> Verdict:
    """Compare two choices for the same actions with the gate, if it was trained for such a sequence.

    The comparison is empty if a choice is not valid, if there is only one action to refine, or if both are equal.
    """
    first = len(sequence.units()[0])
    if not (greedy.valid and refined.valid) or len(greedy.predicted_s) == first or greedy.values == refined.values:
        return Verdict()
    inputs = situation(sequence, greedy, refined)
    actions = sequence.actions[: len(greedy.predicted_s)]
    if model is None or tuple(a.action.name for a in actions if not a.asserted) not in model.sequences:
        return Verdict(inputs)
    p_slowdown = float(model.p_slowdown(np.array([inputs]))[0])
    return Verdict(inputs, p_slowdown, p_slowdown > model.threshold) if math.isfinite(p_slowdown) else Verdict(inputs)


def situation(sequence: ActionSequence, greedy: Choice, refined: Choice) -> tuple[float, ...]:
    """Values by SITUATION."""
    first = len(sequence.units()[0])
    greedy_first_s, greedy_rest_s = _first_and_rest_s(greedy, first)
    refined_first_s, refined_rest_s = _first_and_rest_s(refined, first)
    gain_s = greedy.total_s - refined.total_s
    turned, moved = _distances(sequence.variables, greedy, refined)
    return (
        gain_s,
        100 * gain_s / greedy.total_s,
        refined_first_s - greedy_first_s,
        greedy_first_s,
        greedy_rest_s,
        greedy_rest_s - refined_rest_s,
        sum(refined.std_s) - sum(greedy.std_s),
        max(refined.failure),
        max(refined.failure) - max(greedy.failure),
        turned,
        moved,
        float(first - 1),
    )


def _first_and_rest_s(choice: Choice, first: int) -> tuple[float, float]:
    return sum(choice.predicted_s[:first]), sum(choice.predicted_s[first:])


def _distances(variables: tuple[Variable, ...], one: Choice, other: Choice) -> tuple[float, float]:
    """Maximum difference of periodic angles in rad, and of all other values as a share of the range."""
    turned, moved = 0.0, 0.0
    for identifier, value in one.values.items():
        variable, difference = variables[identifier], abs(value - other.values[identifier])
        if variable.periodic:
            turned = max(turned, min(difference, 2 * math.pi - difference))
        else:
            moved = max(moved, difference / (variable.upper - variable.lower))
    return turned, moved
