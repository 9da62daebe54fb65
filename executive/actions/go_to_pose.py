"""goToPose: drive to a pose and arrive there with a given speed. Ignores balls and obstacles."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.actions.path_follower import Deviation, Pace, Progress, project, speed_limit, tracking_curvature
from tailor.executive.actions.planar import VG, XG, PlanarBelief
from tailor.executive.belief.angles import difference
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.values import Array

ALIGN = "align"  # controller state while the robot turns on the spot at its goal


@dataclass(frozen=True, slots=True)
class GoToPose:
    """Turns towards the path into the goal, follows it, and turns on the spot only after a miss, or to look.

    The path is planned anew each tick until its bend is near. From there on it is kept, in the goal's frame, and
    deviations decay over `settle_m`. With a new path near the goal, a few centimetres of noise beside it would swing
    the robot round where it must face ahead.

    `unseen`, if given, tells from the belief whether the robot has not looked yet where a turn by an angle (rad) leads.
    What stands there would be seen too late to brake, so the robot turns on the spot until it has looked.

    Controller state: None, then a `Progress` on the kept path, then perhaps ALIGN.
    """

    v_max_mps: float
    omega_max_radps: float
    ways: ArrivalPath
    steer_gain: float = 3.5  # rad/s per rad of heading error
    braking_mps2: float = 0.55  # of the motor board, with a reserve
    brake_preview_s: float = 0.0  # lag of the speed behind the command
    keep_m: float = 0.15  # the way is kept when its bend is so near,
    keep_s: float = 0.5  # and so much time,
    keep_rad: float = 0.6  # and the robot faces it
    preview_s: float = 0.40  # lag of turning behind the command
    swing_s: float = 0.18  # for which the robot keeps turning
    settle_m: float = 0.35
    off_path_m: float = 0.25  # beyond, a new path is planned
    off_path_rad: float = 0.8
    past_m: float = 0.10
    sharp_radps: float = math.inf  # the robot slows down where its way asks it to turn faster,
    late_m: float = math.inf  # and where it would still turn towards its way so far into the bend
    near_m: float = 0.15  # within this distance of the goal only the heading is corrected
    stay_m: float = 0.30  # maximum drift while turning on the spot
    reached_m: float = 0.03  # along the goal's heading
    heading_rad: float = 0.20
    aligned_rad: float = 0.10  # turning on the spot ends within this error
    stopping_radps2: float = 1.3  # of the motor board, with a reserve
    still_radps: float = 0.4
    speed_mps: float = 0.10  # tolerance of the arrival speed
    crawl_mps: float = 0.10  # minimum, so that it arrives
    unseen: Callable[[Any, float], bool] | None = None

    def __call__(self, state: Any, now_ns: int, belief: PlanarBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller; the command is (v m/s, omega rad/s)."""
        xg, yg, phig, vg = arguments[XG : VG + 1].tolist()
        pose = _seen_from(belief.pose, xg, yg, phig)
        if self._arrived(belief, pose, vg, state):
            return Control(state, (vg, 0.0), "done")
        if self._aligns(state, pose):
            return Control(ALIGN, (0.0, self._turn(-pose.phi)))
        followed = self._follow(state, belief, pose, vg) if isinstance(state, Progress) else None
        return followed or self._face(belief, pose, vg)

    def _face(self, belief: PlanarBelief, pose: Pose, vg: float) -> Control:
        """Turn towards the path; the speed grows as the heading error falls, from when the robot sees its way."""
        way = Progress(self.ways.quickest((pose.x, pose.y, pose.phi), vg), 0.0)
        error = difference(way.path.start[2], pose.phi)
        if abs(error) < self.keep_rad and way.path.pieces[0][1] < self.keep_m + self.keep_s * max(0.0, belief.v):
            followed = self._follow(way, belief, pose, vg)
            if followed is not None:
                return followed
        blind = self.unseen is not None and self.unseen(belief, error)
        ahead_mps = self._speed(way, vg, belief.v) * max(0.0, math.cos(error))
        return Control(None, (0.0 if blind else min(ahead_mps, self._facing_mps(way, error)), self._turn(error)))

    def _facing_mps(self, way: Progress, error: float) -> float:
        """Speed (m/s) at which the robot has turned by `error` (rad), speeding up and stopping, when the bend comes."""
        turning_s = 2.0 * math.sqrt(abs(error) / self.stopping_radps2)
        return (way.path.pieces[0][1] + self.late_m) / max(turning_s, 1e-6)

    def _follow(self, way: Progress, belief: PlanarBelief, pose: Pose, vg: float) -> Control | None:
        """Follow the kept path; None when the robot has left it."""
        way, off = project(way, pose, 0.3)
        if abs(off.aside_m) > self.off_path_m or abs(off.turned) > self.off_path_rad or way.remaining_m < -self.past_m:
            return None
        swing = self.swing_s * (belief.omega - belief.v * way.path.at(way.s)[3])
        v = max(belief.v, self.crawl_mps)
        off = Deviation(off.aside_m, off.turned + swing)
        curvature = tracking_curvature(way, off, v * self.preview_s, self.settle_m)
        sharp_mps = max(self.crawl_mps, self.sharp_radps / max(abs(curvature), 1e-6))
        return Control(way, (min(sharp_mps, self._speed(way, vg, v)), self._within(v * curvature)))

    def _speed(self, way: Progress, vg: float, v: float) -> float:
        """Speed (m/s) for where the robot will be when its speed `v` has followed the command."""
        bend_mps = self.ways.bend_radps * way.path.radius
        pace = Pace(self.v_max_mps, bend_mps, self.braking_mps2, self.braking_mps2)
        then = Progress(way.path, way.s + v * self.brake_preview_s)
        return max(self.crawl_mps, speed_limit(then, vg, pace))

    def _aligns(self, state: Any, pose: Pose) -> bool:
        """Whether the robot is at its goal, or past it, with a wrong heading; with hysteresis against noise."""
        distance = math.hypot(pose.x, pose.y)
        if state == ALIGN:
            return distance < self.stay_m
        return distance < self.near_m and -pose.x < self.reached_m and abs(pose.phi) > self.heading_rad

    def _arrived(self, belief: PlanarBelief, pose: Pose, vg: float, state: Any) -> bool:
        """Whether position, heading and speed are within tolerance, past the goal's line or after turning."""
        if belief.v > vg + self.speed_mps:
            return False
        distance = math.hypot(pose.x, pose.y)
        if state == ALIGN:
            return abs(pose.phi) < self.aligned_rad and abs(belief.omega) < self.still_radps and distance < self.stay_m
        return distance < self.near_m and -pose.x < self.reached_m and abs(pose.phi) < self.heading_rad

    def _turn(self, off: float) -> float:
        """Turning so that it can be stopped in time."""
        omega = min(self.steer_gain * abs(off), math.sqrt(2 * self.stopping_radps2 * abs(off)))
        return self._within(math.copysign(omega, off))

    def _within(self, omega: float) -> float:
        return max(-self.omega_max_radps, min(self.omega_max_radps, omega))


def _seen_from(pose: Pose, x: float, y: float, phi: float) -> Pose:
    """A pose in the frame of another (m, m, rad)."""
    c, s = math.cos(phi), math.sin(phi)
    dx, dy = pose.x - x, pose.y - y
    return Pose(c * dx + s * dy, c * dy - s * dx, difference(pose.phi, phi), pose.covariance)
