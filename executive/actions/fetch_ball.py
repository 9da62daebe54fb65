"""Getting a lost ball back into the rail: look for it, make room, face it, drive at it gently."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import Pose

Stage = Literal["chase", "clear", "seek left", "seek right", "leave"]
SEEKING = ("seek left", "seek right")


@dataclass(frozen=True, slots=True)
class FetchBall:
    """Velocities towards a ball that is not in the rail; the stage keeps making room until there is room."""

    in_rail_m: float  # axle to ball
    room_m: float = 0.45  # nearer, a ball aside would be knocked away by turning
    cleared_m: float = 0.60
    facing_rad: float = 0.5
    turn_gain: float = 2.5  # rad/s per rad
    omega_max_radps: float = 1.2
    clear_mps: float = 0.25
    touch_mps: float = 0.20  # faster than the ball when it reaches the rail
    v_max_mps: float = 0.7
    unseen_s: float = 0.6  # in view and not seen for so long: it is not there
    in_view_rad: float = 0.7  # a ball in this bearing would be seen
    near_m: float = 0.27
    search_radps: float = 1.0
    # a ball farther off is not `atball`: the next plan begins with an approach
    left_ahead_m: float = 0.75
    left_aside_m: float = 0.30

    def misses(self, stage: Stage, ball: BallTrack, now_ns: int) -> bool:
        """Whether the ball is not where it is believed to be: looked for until it is seen again."""
        unseen_s = 1e-9 * (now_ns - ball.seen_ns)
        if stage in SEEKING:
            return unseen_s > 0.5 * self.unseen_s
        bearing = abs(math.atan2(ball.left, ball.ahead))
        in_view = bearing < self.in_view_rad and math.hypot(ball.ahead, ball.left) > self.near_m
        return in_view and unseen_s > self.unseen_s

    def fetched(self, pose: Pose, ball: BallTrack, rolling_mps2: float) -> Pose:
        """Where a robot that drives straight at the ball has it in the rail, once the ball has rolled to rest."""
        c, s = math.cos(pose.phi), math.sin(pose.phi)
        rolls_s = math.hypot(ball.vx, ball.vy) / (2.0 * rolling_mps2)  # for as long at its present speed
        dx = c * ball.ahead - s * ball.left + rolls_s * ball.vx
        dy = s * ball.ahead + c * ball.left + rolls_s * ball.vy
        distance, heading = math.hypot(dx, dy) - self.in_rail_m, math.atan2(dy, dx)
        x, y = pose.x + distance * math.cos(heading), pose.y + distance * math.sin(heading)
        return Pose(x, y, heading, pose.covariance)

    def left(self, ball: BallTrack) -> bool:
        """Whether the ball lies so far off that it is approached anew."""
        return ball.ahead > self.left_ahead_m or abs(ball.left) > self.left_aside_m

    def __call__(self, stage: Stage, ball: BallTrack, ball_speed: float) -> tuple[Stage, tuple[float, float]]:
        """The next stage and the command (v m/s, omega rad/s).

        Args:
          stage: "chase" at first, then what the last call returned.
          ball: Where the ball is, robot's frame.
          ball_speed: How fast it rolls away, m/s.
        """
        if stage == "leave":
            return stage, (-self.clear_mps, 0.0)
        if stage in SEEKING:
            return stage, (0.0, self.search_radps if stage == "seek left" else -self.search_radps)
        distance, bearing = math.hypot(ball.ahead, ball.left), math.atan2(ball.left, ball.ahead)
        aside = abs(bearing) > self.facing_rad
        if aside and distance < (self.cleared_m if stage == "clear" else self.room_m):
            return "clear", (-math.copysign(self.clear_mps, ball.ahead), 0.0)
        omega = max(-self.omega_max_radps, min(self.omega_max_radps, self.turn_gain * bearing))
        gap = max(0.0, distance - self.in_rail_m)
        v = min(self.v_max_mps, self.touch_mps + max(0.0, ball_speed) + 0.6 * gap)
        return "chase", (v * max(0.0, math.cos(bearing)) ** 3, omega)
