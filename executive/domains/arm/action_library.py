"""The arm's one executable action: reach a waypoint and pass it with given joint velocities (paper Table 6)."""

from __future__ import annotations

import math

from tailor.executive.actions.reach import Reach
from tailor.executive.interfaces.action import Action, Parameter

PAN_RAD = 1.3  # where waypoints may lie
LIFT_RAD = 0.9
PASSING_RADPS = 0.7  # fastest passage that is asked of a joint
ACCELERATION_RADPS2 = 0.87  # a random reach then takes 2.9 s on average (paper Table 1)
ACCELERATION_MAX_RADPS2 = 4.0  # the driver ramps at 5; hardly a reach needs more than 2.5


def fastest_radps(distance_rad: float) -> float:
    """How fast a joint may pass a waypoint whose nearer neighbour lies so far away.

    Up to there a reach's duration has one minimum. Beyond, rushing through and looping back can cost alike, and what is
    best on paper turns out to be the other one.
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
