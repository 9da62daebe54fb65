"""The arm's one executable action: reach a waypoint and pass it with given joint velocities (paper Table 6)."""

from __future__ import annotations

import math

from tailor.executive.actions.reach import Reach
from tailor.executive.domains.arm.load import TRAINED_FRICTION, accelerations
from tailor.executive.domains.arm.predicates import FRICTIONS
from tailor.executive.domains.arm.robot import V_MAX_RADPS
from tailor.executive.interfaces.action import Action, Parameter

PAN_RAD = 1.3  # waypoints lie within these
LIFT_RAD = 0.9
PASSING_RADPS = 1.0  # maximum velocity of a joint at a waypoint
LIFTING_RADPS2 = 1.5  # what reaches plan with upward; otherwise up to load.ACCELERATION_RADPS2
ACCELERATION_MAX_RADPS2 = 4.0  # the driver ramps at 5


def fastest_radps(distance_rad: float) -> float:
    """Maximum velocity (rad/s) of a joint at a waypoint whose nearer neighbour lies `distance_rad` away.

    Up to this velocity the duration of a reach has one minimum. Beyond it, passing fast and looping back can take
    equally long, and the predicted optimum may be the wrong one.
    """
    return min(PASSING_RADPS, math.sqrt(LIFTING_RADPS2 * distance_rad))


def _state(suffix: str, argument: int) -> tuple[Parameter, ...]:
    v = PASSING_RADPS
    return (
        Parameter(f"a{suffix}", argument, "a", "rad", -PAN_RAD, PAN_RAD),
        Parameter(f"wa{suffix}", argument, "wa", "rad/s", -v, v),
        Parameter(f"b{suffix}", argument, "b", "rad", -LIFT_RAD, LIFT_RAD),
        Parameter(f"wb{suffix}", argument, "wb", "rad/s", -v, v),
    )


# of a gear as a multiple of the nominal: what the executive observes on the way, so models need not average over it
FRICTION = tuple(Parameter(name, 0, name, "1", *TRAINED_FRICTION) for name in FRICTIONS)

REACH = Action(
    "reach",
    (*_state("", 0), *_state("g", 1), *FRICTION),
    Reach(accelerations, ACCELERATION_MAX_RADPS2, 0.96 * V_MAX_RADPS),  # the rest is for feedback
    "reach/duration",
)

ACTIONS = {REACH.name: REACH}
EXECUTABLES = {"reach": "reach"}
