"""goToPose of the kitchen robot: bends into far goals, turns and drives straight to near ones.

Near a goal a bend into it is a loop, often against the table. A cylinder that turns on the spot touches nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

from tailor.executive.actions.dubins import Pose2
from tailor.executive.actions.go_to_pose import GoToPose
from tailor.executive.actions.planar import PHI, PHIG, VG, XG, YG, PlanarBelief, X, Y
from tailor.executive.belief.angles import difference
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.values import Array

SEEN = VG + 1  # argument: 1 where the stool has been seen, else 0


@dataclass(frozen=True, slots=True)
class Far:
    """Controller state on the way to a far goal: that of `GoToPose`."""

    inner: Any


@dataclass(frozen=True, slots=True)
class Near:
    """Controller state on the way to a near goal; `side` is 1 for driving ahead, -1 for backing off."""

    phase: Literal["face", "drive", "align"]
    side: Literal[-1, 1]


@dataclass(frozen=True, slots=True)
class DriveToStand:
    """Drives to a pose. Goals within `near_m` at the start: see this module; behind the robot, within `back_m`.

    The robot backs off where that needs less turning. It sees ahead, so it does so for short ways only, until it knows
    where the stool is. Near goals that it faces about as it drives ahead are passed in motion, if they ask for that; at
    the others it stops and turns.
    """

    far: GoToPose
    near_m: float = 1.0
    back_m: float = 2.0  # so far it backs off where the stool has been seen: from any stand to the open middle,
    back_rad: float = 2.2  # if it turns less than this in all: a bend takes 1 to 6 s longer then
    off_rad: float = 0.7  # it begins to drive when it faces the goal within this, the less the nearer it is
    miss_m: float = 0.30  # a bend that ends beside its goal, so near, has missed it,
    bending_rad: float = 0.8  # unless the robot faces farther aside of its goal's heading: then it still bends
    steer_m: float = 0.15  # from here on it steers softer
    there_m: float = 0.05  # so near its goal it only turns
    reached_m: float = 0.02  # along the direction of driving
    aligned_rad: float = 0.10
    still_mps: float = 0.10
    still_radps: float = 0.4

    def side(self, start: Pose2, goal: Pose2, seen: bool) -> Literal[-1, 1] | None:
        """1 where it drives straight ahead to a goal, -1 where it backs off, None where it bends into it.

        Args:
          start: Pose of the robot.
          goal: Pose to drive to.
          seen: Whether the stool has been seen.
        """
        distance, bearing = _sight(*start[:2], *goal[:2])
        backs_off = seen and _turning(bearing + math.pi, start, goal) < self.back_rad
        if distance >= (self.back_m if backs_off else self.near_m):
            return None
        return _side(start, goal)

    def __call__(self, state: Any, now_ns: int, belief: PlanarBelief, arguments: Array) -> Control:
        """See tailor.executive.interfaces.action.Controller; the command is (v m/s, omega rad/s)."""
        x, y, phi, vg = arguments[[XG, YG, PHIG, VG]].tolist()
        pose = belief.pose
        state = state or self._begun(arguments)
        if isinstance(state, Far) and self._has_missed(pose, (x, y, phi)):
            state = Near("face", _side((pose.x, pose.y, pose.phi), (x, y, phi)))
        if isinstance(state, Far):
            control = self.far(state.inner, now_ns, belief, arguments)
            return Control(Far(control.state), control.command, control.outcome, control.detail)
        distance, bearing = _sight(pose.x, pose.y, x, y)
        off = difference(bearing if state.side > 0 else bearing + math.pi, pose.phi)
        passes = vg > 0.0 and state == Near("drive", 1) and abs(difference(phi, pose.phi)) < self.far.heading_rad
        state = self._next(state, distance, off)
        if passes and state.phase == "align" and belief.v < vg + self.far.speed_mps:
            return Control(state, (vg, 0.0), "done")
        if state.phase == "align":
            return self._align(state, belief, difference(phi, pose.phi))
        if state.phase == "face":
            return Control(state, (0.0, self._turn(off)))
        return Control(state, self._drive(state.side, distance, off, vg if passes else 0.0))

    def _begun(self, arguments: Array) -> Far | Near:
        """How it drives, by where that was decided: as predicted, although the robot has moved a little since."""
        x, y, phi, xg, yg, phig, seen = arguments[[X, Y, PHI, XG, YG, PHIG, SEEN]].tolist()
        side = self.side((x, y, phi), (xg, yg, phig), seen >= 0.5)
        return Far(None) if side is None else Near("face", side)

    def _has_missed(self, pose: Pose, goal: Pose2) -> bool:
        """Whether a bend has led beside or past its goal. Another one would be a loop, mostly against a table."""
        x, y, phi = goal
        distance, bearing = _sight(x, y, pose.x, pose.y)
        is_past = distance * math.cos(bearing - phi) > -self.reached_m
        has_bent = abs(difference(phi, pose.phi)) < self.bending_rad
        return is_past and has_bent and self.far.near_m < distance < self.miss_m

    def _next(self, state: Near, distance: float, off: float) -> Near:
        """The phase now, where the goal is `off` radians left of the direction of driving."""
        if state.phase == "face" and distance < self.there_m:
            return Near("align", state.side)
        if state.phase == "face" and abs(off) < self.off_rad * min(1.0, distance / self.near_m):
            return Near("drive", state.side)
        if state.phase == "drive" and distance * math.cos(off) < self.reached_m:
            return Near("align", state.side)
        return state

    def _drive(self, side: int, distance: float, off: float, passing_mps: float) -> tuple[float, float]:
        """Straight to the goal, slower while it turns towards it."""
        braking_mps = math.sqrt(passing_mps**2 + 2.0 * self.far.braking_mps2 * distance * math.cos(off))
        v = max(self.far.crawl_mps, min(self.far.v_max_mps, braking_mps))
        return side * v * math.cos(off), self._turn(off) * min(1.0, distance / self.steer_m)

    def _align(self, state: Near, belief: PlanarBelief, off: float) -> Control:
        """Turn to the goal's heading, which is `off` radians to the left."""
        still = abs(belief.omega) < self.still_radps and abs(belief.v) < self.still_mps
        if still and abs(off) < self.aligned_rad:
            return Control(state, (0.0, 0.0), "done")
        return Control(state, (0.0, self._turn(off)))

    def _turn(self, off: float) -> float:
        """Turning rate (rad/s) that can be stopped in time."""
        rate = min(self.far.steer_gain * abs(off), math.sqrt(2.0 * self.far.stopping_radps2 * abs(off)))
        return math.copysign(min(rate, self.far.omega_max_radps), off)


def _sight(x: float, y: float, xg: float, yg: float) -> tuple[float, float]:
    """Distance and bearing of a goal."""
    return math.hypot(xg - x, yg - y), math.atan2(yg - y, xg - x)


def _side(start: Pose2, goal: Pose2) -> Literal[-1, 1]:
    """1 to drive ahead, -1 to back off: whichever needs less turning from the start's heading to the goal's."""
    _, bearing = _sight(*start[:2], *goal[:2])
    return 1 if _turning(bearing, start, goal) <= _turning(bearing + math.pi, start, goal) else -1


def _turning(heading: float, start: Pose2, goal: Pose2) -> float:
    """Angle that a robot turns in all which drives with this heading."""
    return abs(difference(heading, start[2])) + abs(difference(goal[2], heading))
