"""The kitchen robot's executable actions: parameters, controllers, models (paper Table 6).

A label of the plan denotes a place: the robot's stand (x, y, phi, v), and the spot of a cup (spot_x, spot_y, handle).
"""

from __future__ import annotations

import math
from dataclasses import replace

from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.actions.go_to_pose import GoToPose
from tailor.executive.domains.kitchen.arm_tasks import FOLD, GRIP, PUT, REACH_SPOT
from tailor.executive.domains.kitchen.drive_context import FURNITURE
from tailor.executive.domains.kitchen.drive_to_stand import DriveToStand
from tailor.executive.interfaces.action import Action, Parameter
from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M, OMEGA_MAX_RADPS, V_MAX_MPS

ASIDE_RAD = 0.3  # how far aside of the line from the shoulder a hand may point
CRAWL_MPS = 0.07  # an exact base would else arrive with the very speed that is too fast
NEAR_M = 0.06  # from its goal at most: the arm reaches little farther than from the edge of a stand
WALL_M = 0.1  # from the base to a wall at least
PASSING_MPS = 0.35  # maximum speed at a subgoal: faster, the bend into it would be wider than the others
CUP_MOVED_M, HANDLE_TURNED_RAD = 0.05, 0.3  # a cup that turns out to stand elsewhere by this is decided anew


def _inside(room: tuple[float, float]) -> tuple[float, float]:
    """Where the robot's middle may be, clear of the walls."""
    return round(room[0] + BASE_RADIUS_M + WALL_M, 3), round(room[1] - BASE_RADIUS_M - WALL_M, 3)


def _pose(suffix: str, argument: int) -> tuple[Parameter, ...]:
    return (
        Parameter(f"x{suffix}", argument, "x", "m", *_inside(kitchen().x)),
        Parameter(f"y{suffix}", argument, "y", "m", *_inside(kitchen().y)),
        Parameter(f"phi{suffix}", argument, "phi", "rad", -math.pi, math.pi, periodic=True),
    )


def _speed(suffix: str, argument: int, upper_mps: float) -> Parameter:
    """A drive passes subgoals in motion; stands are at rest. One that is decided anew begins at the believed speed."""
    return Parameter(f"v{suffix}", argument, "v", "m/s", 0.0, upper_mps)


def _spot(argument: int) -> tuple[Parameter, ...]:
    """Parameters of the arm's actions, of the place in that argument; see arm_tasks."""
    return (
        *_pose("", argument),
        Parameter("spot_x", argument, "spot_x", "m", *kitchen().x, tolerance=CUP_MOVED_M),
        Parameter("spot_y", argument, "spot_y", "m", *kitchen().y, tolerance=CUP_MOVED_M),
        Parameter("aside", argument, "aside", "rad", -ASIDE_RAD, ASIDE_RAD),
    )


def _hand() -> tuple[Parameter, ...]:
    """Parameters of an arm that comes home: as those of `_spot`, but the spot is wherever the hand is."""
    return tuple(
        replace(each, quantity=f"hand_{each.name.removeprefix('spot_')}", tolerance=None)
        if each.name in ("spot_x", "spot_y", "aside")
        else each
        for each in _spot(0)
    )


def _out(argument: int) -> Parameter:
    return Parameter("out", argument, "out", "1", 0.0, 1.0)


def _handle(argument: int) -> Parameter:
    return Parameter("handle", argument, "handle", "rad", -math.pi, math.pi, True, HANDLE_TURNED_RAD)


# whether the stool has been seen, 1 or 0: observed, not chosen; then the robot backs off farther
SEEN = Parameter("seen", 0, "seen", "1", 0.0, 1.0)

GO_TO_POSE = Action(
    "goToPose",
    (*_pose("", 0), _speed("", 0, V_MAX_MPS), *_pose("g", 1), _speed("g", 1, PASSING_MPS), SEEN),
    DriveToStand(
        GoToPose(
            V_MAX_MPS,
            OMEGA_MAX_RADPS,
            ArrivalPath(V_MAX_MPS, bend_radps=0.8, bend_worth_radps=0.6),
            near_m=NEAR_M,
            crawl_mps=CRAWL_MPS,
        )
    ),
    "goToPose/duration",
    subgoal_action="goToPose",
    context=FURNITURE,
    drives=("base",),
)
REACH = Action("reach", _spot(0), REACH_SPOT, "reach/duration", drives=("arm",))
# rest to rest by the same joint angles, it takes as long as to reach there
FOLD_ARM = Action("fold", _hand(), FOLD, "reach/duration", drives=("arm",))
GRIP_CUP = Action("grip", (*_spot(1), _out(1), _handle(1)), GRIP, "grip/duration", drives=("arm", "gripper"))
PUT_CUP = Action("put", (*_spot(1), _out(1)), PUT, "put/duration", drives=("arm", "gripper"))

ACTIONS = {action.name: action for action in (GO_TO_POSE, REACH, FOLD_ARM, GRIP_CUP, PUT_CUP)}
EXECUTABLES = {"navigate": "goToPose", "reach": "reach", "fold": "fold", "grip": "grip", "put": "put"}
