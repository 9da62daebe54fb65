"""approachBall: goToPose to behind a ball, with the goal kept where the ball is seen.

Robot and ball are known in the map no better than the camera localises the robot; where the ball lies before the
robot is known far better. A goal that keeps its place in the map ends a rail's clearance beside the ball.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from tailor.executive.actions.go_to_pose import GoToPose
from tailor.executive.actions.planar import PHIG, XG, YG, BallBelief
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.values import Array


@dataclass(frozen=True, slots=True)
class ApproachBall:
    """Shifts the goal as far as the ball lies off the place that the goal implies, then goes there."""

    go: GoToPose
    behind_m: float  # from the axle to the ball where an approach ends
    follow_m: float  # a ball farther off along either axis has been moved; the executive then deliberates anew

    def __call__(self, state: Any, now_ns: int, belief: BallBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller; the command is (v m/s, omega rad/s)."""
        return self.go(state, now_ns, belief, self._followed(arguments, belief.ball_xy))

    def _followed(self, arguments: Array, ball_xy: tuple[float, float] | None) -> Array:
        if ball_xy is None:
            return arguments
        heading = arguments[PHIG]
        dx = ball_xy[0] - (arguments[XG] + self.behind_m * math.cos(heading))
        dy = ball_xy[1] - (arguments[YG] + self.behind_m * math.sin(heading))
        if max(abs(dx), abs(dy)) > self.follow_m:
            return arguments
        goal = arguments.copy()
        goal[XG] += dx
        goal[YG] += dy
        return goal
