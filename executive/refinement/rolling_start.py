"""Courses that begin in motion where the models know starts at rest only: the robot rolls on before it obeys.

A parameter's range is what the models have learned. Where an action's drives begin at rest, a faster robot drives on
while it turns to its new way, and passes objects elsewhere than predicted from where it is.
"""

from __future__ import annotations

import math
from dataclasses import replace

from tailor.executive.refinement.assertion.asserted_subgoal import start_indices
from tailor.executive.refinement.objective.sequence import ActionSequence

# At the speed beyond the range: so far B21, whose drives began at rest, drove on in traced runs that dropped a subgoal
# and touched the fridge
ROLL_S = 0.8
POSE = ("x", "y", "phi", "v")
STILL_MPS = 0.05  # beyond the range: as much as an arrival varies


def begins_too_fast(course: ActionSequence) -> bool:
    """Whether the robot is faster than its first action may begin, for all that the models have learned.

    Args:
      course: Its first action starts from the believed state. Without x, y, phi and v there it is never too fast.
    """
    start = _start(course)
    if start is None:
        return False
    first = course.actions[0]
    v = course.variables[first.variables[start[-1]]].value
    return v is not None and v > first.action.parameters[start[-1]].upper + STILL_MPS


def rolled_on(course: ActionSequence) -> ActionSequence | None:
    """The course from where the robot rolls on to until it is as slow as its first action may begin.

    None if it does not begin too fast.
    """
    start = _start(course)
    if start is None or not begins_too_fast(course):
        return None
    first = course.actions[0]
    ids = [first.variables[j] for j in start]
    x, y, phi, v = (course.variables[i].value or 0.0 for i in ids)
    roll_m = ROLL_S * (v - first.action.parameters[start[-1]].upper)
    variables = list(course.variables)
    for i, value in ((ids[0], x + roll_m * math.cos(phi)), (ids[1], y + roll_m * math.sin(phi))):
        variables[i] = variables[i].bound_to(value)
    return replace(course, variables=tuple(variables))


def _start(course: ActionSequence) -> tuple[int, ...] | None:
    """Indices of x, y, phi and v among the first action's parameters, where it starts; None if one is missing."""
    action = course.actions[0].action
    indices = {action.parameters[j].quantity: j for j in start_indices(action)}
    return tuple(indices[quantity] for quantity in POSE) if indices.keys() >= set(POSE) else None
