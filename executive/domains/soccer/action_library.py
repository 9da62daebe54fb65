"""The soccer robot's executable actions: parameters, controllers, models (paper Table 6).

A label of the plan denotes a place. For approachBall's goal and for dribbleBall the place's x, y is the ball's
position and phi the robot's heading there; controllers and models take poses of the robot's axle.
"""

from __future__ import annotations

import math

from tailor.executive.actions.approach_ball import ApproachBall
from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.actions.dribble_ball import DribbleBall
from tailor.executive.actions.fetch_ball import FetchBall
from tailor.executive.actions.go_to_pose import GoToPose
from tailor.executive.actions.rail_grip import RailGrip
from tailor.executive.domains.soccer import balls, opponents, robot
from tailor.executive.domains.soccer.behind import Behind
from tailor.executive.domains.soccer.subgoal_risk import BallContactRisk
from tailor.executive.interfaces.action import Action, Parameter
from tailor.executive.interfaces.action_context import ActionContext, ContextColumn

FIELD_X_M = 3.5
FIELD_Y_M = 2.25
PASSING_MPS = 0.6  # maximum arrival speed of goToPose
AT_BALL_MPS = 0.3  # maximum speed of `atball` (paper 6.1)
# a running approach is deliberated anew when its goal has moved so far: two deviations of a ball seen from 3 m
BALL_MOVED_M = 0.25
OPPONENT_MOVED_M = 0.12  # when an opponent turns out to stand elsewhere by this, the way is decided anew
TOUCHED = "touched opponent"
TOUCH_COST_S = 30.0  # a robot that has driven against an opponent mostly stays there: two actions run out of time


def _places(start_mps: float, goal_mps: float, ball_tolerance: float | None = None) -> tuple[Parameter, ...]:
    """x, y, phi, v of the first label and of the second."""
    made = []
    for suffix, argument, speed_mps, tolerance in (("", 0, start_mps, None), ("g", 1, goal_mps, ball_tolerance)):
        made += [
            Parameter(f"x{suffix}", argument, "x", "m", -FIELD_X_M, FIELD_X_M, tolerance=tolerance),
            Parameter(f"y{suffix}", argument, "y", "m", -FIELD_Y_M, FIELD_Y_M, tolerance=tolerance),
            Parameter(f"phi{suffix}", argument, "phi", "rad", -math.pi, math.pi, periodic=True),
            Parameter(f"v{suffix}", argument, "v", "m/s", 0.0, speed_mps),
        ]
    return tuple(made)


# Goal place -> pose of the axle behind the ball, with the clearance in which an approach ends
behind_goal = Behind((4,), robot.BEHIND_BALL_M)
# Both places -> poses of the axle with the ball in the rail
behind_both = Behind((0, 4), robot.IN_RAIL_M)

_ways = ArrivalPath(robot.V_MAX_MPS)
_go = GoToPose(
    robot.V_MAX_MPS,
    robot.OMEGA_MAX_RADPS,
    _ways,
    brake_preview_s=robot.SPEED_LAG_S,
    sharp_radps=robot.SHARP_RADPS,
    late_m=robot.LATE_M,
    unseen=opponents.unseen,
)
_grip = RailGrip(robot.IN_RAIL_M, robot.BALL_ROLLING_MPS2)
_dribble = DribbleBall(FetchBall(robot.IN_RAIL_M), _grip)

# goToPose ignores opponents, and so does an approach, which is goToPose: one model covers both
OPPONENTS = ActionContext(
    (
        ContextColumn("obstacle_x", "m", -FIELD_X_M, FIELD_X_M, OPPONENT_MOVED_M),
        ContextColumn("obstacle_y", "m", -FIELD_Y_M, FIELD_Y_M, OPPONENT_MOVED_M),
        ContextColumn("obstacle_r", "m", *opponents.RADII_M),
    ),
    opponents.rows,
    "goToPose/clearance",
    TOUCHED,
    TOUCH_COST_S,
)

GO_TO_POSE = Action(
    "goToPose",
    _places(PASSING_MPS, PASSING_MPS),
    _go,
    "goToPose/duration",
    subgoal_action="goToPose",
    context=OPPONENTS,
)
APPROACH_BALL = Action(
    "approachBall",
    _places(PASSING_MPS, AT_BALL_MPS, BALL_MOVED_M),
    balls.WithItsBall(ApproachBall(_go, robot.BEHIND_BALL_M, BALL_MOVED_M), balls.approached),
    "approachBall/duration",
    "approachBall/success",
    subgoal_action="goToPose",
    subgoal_risk=BallContactRisk(_ways),
    arguments=behind_goal,
    spans=behind_goal.spans,
    context=OPPONENTS,
)
DRIBBLE_BALL = Action(
    "dribbleBall",
    _places(AT_BALL_MPS, AT_BALL_MPS),
    balls.WithItsBall(_dribble, balls.dribbled),
    "dribbleBall/duration",
    arguments=behind_both,
    spans=behind_both.spans,
)

ACTIONS = {action.name: action for action in (GO_TO_POSE, APPROACH_BALL, DRIBBLE_BALL)}
EXECUTABLES = {"gotopose": "goToPose", "approachball": "approachBall", "dribbleball": "dribbleBall"}
