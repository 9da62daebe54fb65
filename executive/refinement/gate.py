"""When not to refine (paper 6.3.2): a tree looks at the greedy and the refined choice and may keep the greedy one.

"The learned decision tree is essentially an action model too: it predicts the outcome of applying action models to
actions." So what it sees knows no robot: what the models say of both choices, and how far these are apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.models import RefinementGate
from tailor.executive.refinement.objective.choice import Choice
from tailor.executive.refinement.objective.sequence import ActionSequence, Variable
from tailor.schemas.errors import UsageError

# What the tree sees, in this order; training takes it from the telemetry, so it is computed in one place alone.
# "First" is the next action with its detours, "rest" what follows it within the horizon; times are predicted means.
SITUATION = (
    "gain_s",  # objective, greedy minus refined
    "gain_pct",  # of greedy's
    "price_s",  # how much longer the first takes when refined
    "first_s",  # greedy's
    "rest_s",  # greedy's
    "return_s",  # how much shorter the rest takes when refined
    "spread_s",  # how much further the models' trees are apart when refined, summed over the actions
    "failure",  # the largest predicted probability, refined
    "failure_more",  # than greedy's
    "turned_rad",  # the largest angle between the two choices
    "moved",  # the largest other difference, as a share of its range
    "detours",  # put before the first
)
NOT_ASKED = -1.0


@dataclass(frozen=True, slots=True)
class Verdict:
    """What the tree saw and said; empty where there was nothing to compare."""

    situation: tuple[float, ...] = ()  # by SITUATION
    p_slowdown: float = NOT_ASKED  # risk that refining costs time, 0..1
    keep_greedy: bool = False


def check_gate(model: RefinementGate) -> RefinementGate:
    """The model, if it asks what is told here; raises UsageError otherwise."""
    if model.input_names != SITUATION:
        raise UsageError(
            f"the benefit tree asks for {', '.join(model.input_names)}, expected {', '.join(SITUATION)}: "
            "train it again with `tailor train-gate`"
        )
    return model


def judge(sequence: ActionSequence, greedy: Choice, refined: Choice, model: RefinementGate | None) -> Verdict:
    """Compare two choices of one stretch and ask the tree, if there is one for such a sequence.

    Where the greedy choice is not valid, or looks ahead as far as the refined one, there is nothing to decide.
    """
    first = len(sequence.units()[0])
    if not (greedy.valid and refined.valid) or len(greedy.predicted_s) == first or greedy.values == refined.values:
        return Verdict()
    seen = situation(sequence, greedy, refined)
    stretch = sequence.actions[: len(greedy.predicted_s)]
    if model is None or tuple(a.action.name for a in stretch if not a.asserted) not in model.sequences:
        return Verdict(seen)
    p_slowdown = float(model.p_slowdown(np.array([seen]))[0])
    return Verdict(seen, p_slowdown, p_slowdown > model.threshold) if math.isfinite(p_slowdown) else Verdict(seen)


def situation(sequence: ActionSequence, greedy: Choice, refined: Choice) -> tuple[float, ...]:
    """The values that SITUATION names."""
    first = len(sequence.units()[0])
    head_s, rest_s = _parts(greedy, first)
    refined_head_s, refined_rest_s = _parts(refined, first)
    gain_s = greedy.total_s - refined.total_s
    turned, moved = _apart(sequence.variables, greedy, refined)
    return (
        gain_s,
        100 * gain_s / greedy.total_s,
        refined_head_s - head_s,
        head_s,
        rest_s,
        rest_s - refined_rest_s,
        sum(refined.spread_s) - sum(greedy.spread_s),
        max(refined.failure),
        max(refined.failure) - max(greedy.failure),
        turned,
        moved,
        float(first - 1),
    )


def _parts(choice: Choice, first: int) -> tuple[float, float]:
    return sum(choice.predicted_s[:first]), sum(choice.predicted_s[first:])


def _apart(variables: tuple[Variable, ...], one: Choice, other: Choice) -> tuple[float, float]:
    """Largest difference of angles that wrap, rad, and of all else, as a share of the range."""
    turned, moved = 0.0, 0.0
    for identifier, value in one.values.items():
        variable, off = variables[identifier], abs(value - other.values[identifier])
        if variable.periodic:
            turned = max(turned, min(off, 2 * math.pi - off))
        else:
            moved = max(moved, off / (variable.upper - variable.lower))
    return turned, moved
