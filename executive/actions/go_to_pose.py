"""goToPose: drive to a pose and arrive there with a given speed. Knows nothing of balls or obstacles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

from executive.actions.arrival_path import ArrivalPath
from executive.actions.path_follower import Pace, Progress, project, speed_limit, tracking_curvature
from executive.actions.planar import VG, XG, PlanarBelief
from executive.belief.angles import difference
from executive.belief.planar_ekf import Pose
from executive.library import Array, Control

Align = Literal["align"]


@dataclass(frozen=True, slots=True)
class GoToPose:
    """Faces the way into the goal, follows it, and turns on the spot only when it has missed.

    Memory: None while it turns to face the way, the way (in the goal's frame) and how far along it is, or "align".
    """

    v_max_mps: float
    omega_max_radps: float
    bend_radps: float = 1.2
    radius_m: float = 0.30
    grow: float = 1.0
    steer_gain: float = 2.8  # rad/s per rad of heading error
    slow_in_turns: float = 1.5  # exponent of the cosine of the heading error
    braking_mps2: float = 0.55  # what the motor board does, with a reserve
    bend_braking: float = 0.55
    commit_rad: float = 0.40
    commit_m: float = 0.15
    commit_s: float = 0.7
    preview_s: float = 0.35
    settle_m: float = 0.35
    off_path_m: float = 0.25
    off_path_rad: float = 0.8
    near_m: float = 0.15  # so close to the goal only the heading is left to correct
    stay_m: float = 0.30  # turning on the spot may have carried it so far
    reached_m: float = 0.03  # along the goal's heading
    heading_rad: float = 0.20
    aligned_rad: float = 0.10  # turning on the spot goes on until here
    stopping_radps2: float = 1.3  # what the motor board does, with a reserve
    still_radps: float = 0.4
    speed_mps: float = 0.10  # by which the arrival may be too fast

    def __call__(self, memory: Any, now_ns: int, belief: PlanarBelief, arguments: Array) -> Control:
        """See executive.library.Controller; the command is (v m/s, omega rad/s)."""
        xg, yg, phig, vg = arguments[XG : VG + 1].tolist()
        pose = _seen_from(belief.pose, xg, yg, phig)
        if self._arrived(belief, pose, vg, memory):
            return Control(memory, (vg, 0.0), "done")
        distance = math.hypot(pose.x, pose.y)
        if distance < (self.stay_m if memory == "align" else self.near_m) and (
            memory == "align" or (-pose.x < self.reached_m and abs(pose.phi) > self.heading_rad)
        ):
            return Control("align", (0.0, self._turn(-pose.phi)))
        if isinstance(memory, Progress):
            followed = self._follow(memory, belief, pose, vg)
            if followed is not None:
                return followed
        path = self._planner().quickest((pose.x, pose.y, pose.phi), self._radius(vg))
        error = difference(path.start[2], pose.phi)
        if abs(error) < self.commit_rad and path.pieces[0][1] < self.commit_m + self.commit_s * max(0.0, belief.v):
            followed = self._follow(Progress(path, 0.0), belief, pose, vg)
            if followed is not None:
                return followed
        v = speed_limit(Progress(path, 0.0), vg, self._pace(path.radius))
        return Control(None, (v * max(0.0, math.cos(error)) ** self.slow_in_turns, self._turn(error)))

    def _follow(self, progress: Progress, belief: PlanarBelief, pose: Pose, vg: float) -> Control | None:
        progress, off = project(progress, pose, 0.3)
        if abs(off.aside_m) > self.off_path_m or abs(off.turned) > self.off_path_rad:
            return None
        if progress.remaining_m < -0.1:
            return None
        v = max(0.1, speed_limit(progress, vg, self._pace(progress.path.radius)))
        speed = max(belief.v, 0.1)
        omega = speed * tracking_curvature(progress, off, speed * self.preview_s, self.settle_m)
        omega = max(-self.omega_max_radps, min(self.omega_max_radps, omega))
        return Control(progress, (v, omega))

    def _planner(self) -> ArrivalPath:
        return ArrivalPath(self.v_max_mps, self.bend_radps, 1.3)

    def _pace(self, radius: float) -> Pace:
        return Pace(self.v_max_mps, self.bend_radps * radius, self.braking_mps2, self.bend_braking)

    def _radius(self, vg: float) -> float:
        return max(self.radius_m, self.grow * vg / self.bend_radps)

    def _arrived(self, belief: PlanarBelief, pose: Pose, vg: float, memory: Any) -> bool:
        """Near enough, headed right, and past the goal's line or done with turning; not too fast."""
        if belief.v > vg + self.speed_mps:
            return False
        distance = math.hypot(pose.x, pose.y)
        if memory == "align":
            return abs(pose.phi) < self.aligned_rad and abs(belief.omega) < self.still_radps and distance < self.stay_m
        return distance < self.near_m and -pose.x < self.reached_m and abs(pose.phi) < self.heading_rad

    def _turn(self, off: float) -> float:
        """Turning on the spot so that it can be stopped in time."""
        return math.copysign(min(abs(self._steer(off)), math.sqrt(2 * self.stopping_radps2 * abs(off))), off)

    def _steer(self, error: float) -> float:
        return max(-self.omega_max_radps, min(self.omega_max_radps, self.steer_gain * error))


def _seen_from(pose: Pose, x: float, y: float, phi: float) -> Pose:
    """A pose in the frame of another."""
    c, s = math.cos(phi), math.sin(phi)
    dx, dy = pose.x - x, pose.y - y
    return Pose(c * dx + s * dy, c * dy - s * dx, difference(pose.phi, phi), pose.covariance)
