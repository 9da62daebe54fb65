"""The arm's one executable action: reach a waypoint and pass it with given joint velocities (paper Table 6)."""

from __future__ import annotations

import math

from tailor.executive.actions.reach import Reach
from tailor.executive.interfaces.action import Action, Parameter

PAN_RAD = 1.3  # waypoints lie within these
LIFT_RAD = 0.9
PASSING_RADPS = 0.7  # maximum velocity of a joint at a waypoint
ACCELERATION_RADPS2 = 0.87  # a random reach then takes 2.9 s on average (paper Table 1)
ACCELERATION_MAX_RADPS2 = 4.0  # the driver ramps at 5; hardly a reach needs more than 2.5


def fastest_radps(distance_rad: float) -> float:
    """Maximum velocity (rad/s) of a joint at a waypoint whose nearer neighbour lies `distance_rad` away.

    Up to this velocity the duration of a reach has one minimum. Beyond it, passing fast and looping back can take
    equally long, and the predicted optimum may be the wrong one.
    """
    return min(PASSING_RADPS, math.sqrt(ACCELERATION_RADPS2 * distance_rad))


def _state(suffix: str, argument: int) -> tuple[Parameter, ...]:
    v = PASSING_RADPS
    return (
        Parameter(f"a{suffix}", argument, "a", "rad", -PAN_RAD, PAN_RAD),
        Parameter(f"wa{suffix}", argument, "wa", "rad/s", -v, v),
        Parameter(f"b{suffix}", argument, "b", "rad", -LIFT_RAD, LIFT_RAD),
        Parameter(f"wb{suffix}", argument, "wb", "rad/s", -v, v),
    )


REACH = Action(
    "reach",
    (*_state("", 0), *_state("g", 1)),
    Reach(ACCELERATION_RADPS2, ACCELERATION_MAX_RADPS2),
    "reach/duration",
)

ACTIONS = {REACH.name: REACH}
EXECUTABLES = {"reach": "reach"}
