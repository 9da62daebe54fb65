"""The pose in the map from a localiser that speaks seldom, or not at all, carried on by odometry. Pure.

A localiser such as AMCL publishes after each update only, thus never while the robot stands. Each of its poses gives
the transform from the odometry's frame to the map; odometry measures how far the robot has come since. Units: m, rad.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass

from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.simnodes.hardware.localiser_check import Doubt, FrozenCheck, LocaliserCheck

JUMP_M, JUMP_MPS = 0.5, 10.0  # a longer step of the odometry than both together is none that a robot has made
JUMP_RAD, JUMP_RADPS = 0.5, 10.0  # nor is a larger turn
ANEW_NS = 500_000_000  # a base that restarts is silent for longer, or its clock is another one
ZERO, AWAY = 0.02, 0.1  # m or rad: odometry at zero that was farther away before
APART_NS = 500_000_000  # between a pose of the localiser and the odometry of its time, if the robot has moved since
STOOD_M, STOOD_RAD = 0.02, 0.02  # odometry of a standing robot may creep by so much
HISTORY = 256  # odometry that is kept for a late localiser: 5 s at 50 Hz
Planar = tuple[float, float, float]


def composed(first: Planar, second: Planar) -> Planar:
    """The pose `second`, given relative to `first`, in the frame of `first`."""
    (x, y, phi), (dx, dy, dphi) = first, second
    cos, sin = math.cos(phi), math.sin(phi)
    return x + cos * dx - sin * dy, y + sin * dx + cos * dy, math.remainder(phi + dphi, math.tau)


def inverse(pose: Planar) -> Planar:
    """The frame of a pose, seen from the pose."""
    x, y, phi = pose
    cos, sin = math.cos(phi), math.sin(phi)
    return -cos * x - sin * y, sin * x - cos * y, -phi


@dataclass(frozen=True, slots=True)
class Drift:
    """Errors of the odometry that add up: standard deviations in m per m driven, and in rad per rad turned."""

    per_m: float = 0.05
    per_rad: float = 0.05


class PoseTracker:
    """Newest pose in the map.

    Attributes:
      known: Whether there is a pose: a start was given, or the localiser has spoken.
    """

    def __init__(self, start: Planar | None, drift: Drift, doubt: Doubt | None = None) -> None:
        """Nothing was received yet.

        Args:
          start: Pose in the map when odometry begins, taken as exact; None: wait for the localiser.
          drift: Errors of the odometry.
          doubt: Limits of the standard deviations, beyond which the pose is unknown; None: there are none.
        """
        self.known = False
        self._check, self._frozen = LocaliserCheck(), FrozenCheck()
        self._start, self._drift, self._doubt = start, drift, doubt or Doubt()
        self._history: deque[tuple[int, Planar, float, float]] = deque(maxlen=HISTORY)
        self._distance_m, self._turned_rad = 0.0, 0.0
        self._to_map: Planar = (0.0, 0.0, 0.0)  # odometry's frame in the map
        self._variances = (0.0, 0.0, 0.0)  # at the localiser's newest pose
        self._since = (0.0, 0.0)  # distance and turn at that pose

    def move(self, odometry: Odometry) -> str:
        """Take odometry into account.

        Returns:
          Text if it jumped, e.g. since the base has restarted, or if it has carried the pose too far: the pose is then
          unknown until the localiser speaks.
        """
        pose = (odometry.x, odometry.y, odometry.phi)
        jump = self._jump(odometry)
        if jump:
            self._history.clear()
            self._frozen = FrozenCheck()  # odometry has another frame now
            self.lose()
        elif self._history:
            last = self._history[-1][1]
            self._distance_m += math.dist(last[:2], pose[:2])
            self._turned_rad += abs(math.remainder(pose[2] - last[2], math.tau))
        elif self._start is not None and not self.known:
            self._to_map, self.known = composed(self._start, inverse(pose)), True
        self._history.append((odometry.stamp_ns, pose, self._distance_m, self._turned_rad))
        return jump or self._carried_too_far()

    def lose(self) -> None:
        """The pose is unknown from now on, until the localiser speaks."""
        self._start, self.known = None, False

    def _carried_too_far(self) -> str:
        doubt = self._doubt.exceeded(*self._present_variances()) if self.known else ""
        if not doubt:
            return ""
        self.lose()
        way_m, turn_rad = self._distance_m - self._since[0], self._turned_rad - self._since[1]
        return f"has carried the pose for {way_m:.1f} m and {turn_rad:.1f} rad: {doubt}"

    def _jump(self, odometry: Odometry) -> str:
        if not self._history:
            return ""
        stamp_ns, last, *_ = self._history[-1]
        step_m = math.dist(last[:2], (odometry.x, odometry.y))
        turn_rad = abs(math.remainder(odometry.phi - last[2], math.tau))
        passed_ns = odometry.stamp_ns - stamp_ns
        is_zero = max(abs(odometry.x), abs(odometry.y), abs(odometry.phi)) < ZERO
        silent = not 0 <= passed_ns <= ANEW_NS
        # without stamps no silence shows; only one that restarts is at zero to the last digit after such a step
        restarted = not stamp_ns and not odometry.stamp_ns and not (odometry.x or odometry.y or odometry.phi)
        if is_zero and max(step_m, turn_rad) > AWAY and (silent or restarted):
            return "began anew at zero"
        passed_s = 1e-9 * max(0, passed_ns)
        if step_m > JUMP_M + JUMP_MPS * passed_s:
            return f"jumped by {step_m:.1f} m"
        return f"jumped by {turn_rad:.1f} rad" if turn_rad > JUMP_RAD + JUMP_RADPS * passed_s else ""

    def correct(self, seen: PoseEstimate) -> str:
        """Take a pose of the localiser, valid at its stamp; without odometry it is ignored.

        Returns:
          Text if no odometry is of its time and the robot has moved since: the pose is then ignored. Or text if the
          localiser does not know where the robot is, or contradicts itself: then nobody does.
        """
        if not self._history:
            return ""
        doubt = self._doubt.exceeded(seen.var_x, seen.var_y, seen.var_phi)
        if doubt:
            self.lose()
            return f"the localiser is lost: {doubt}"
        near, apart_ns = self._history[-1], 0
        if seen.stamp_ns and near[0]:  # else a stamp is missing: the newest odometry
            near = min(self._history, key=lambda entry: abs(entry[0] - seen.stamp_ns))
            apart_ns = abs(near[0] - seen.stamp_ns)
        if apart_ns > APART_NS and not self._stands():
            return f"is {apart_ns * 1e-9:.1f} s from any odometry, expected stamps of one clock"
        _, pose, distance_m, turned_rad = near
        jumps = self._check.fault(seen, composed(self._to_map, pose)) if self.known else ""
        if fault := self._frozen.fault(seen, pose) or jumps:
            self.lose()
            return fault
        self._to_map = composed((seen.x, seen.y, seen.phi), inverse(pose))
        self._variances, self._since = (seen.var_x, seen.var_y, seen.var_phi), (distance_m, turned_rad)
        self.known = True
        return ""

    def _stands(self) -> bool:
        """Whether the robot has stood for as long as odometry is kept: a pose of before still holds."""
        (_, _, distance_m, turned_rad), (*_, far_m, far_rad) = self._history[0], self._history[-1]
        return far_m - distance_m < STOOD_M and far_rad - turned_rad < STOOD_RAD

    def pose(self) -> PoseEstimate | None:
        """The pose at the newest odometry; None if it is not known."""
        if not self.known or not self._history:
            return None
        stamp_ns, odometry, *_ = self._history[-1]
        return PoseEstimate(stamp_ns, *composed(self._to_map, odometry), *self._present_variances())

    def _present_variances(self) -> Planar:
        """Those of the localiser's newest pose, and of the way and turn since."""
        moved = ((self._distance_m - self._since[0]) * self._drift.per_m) ** 2
        turned = ((self._turned_rad - self._since[1]) * self._drift.per_rad) ** 2
        var_x, var_y, var_phi = self._variances
        return var_x + moved, var_y + moved, var_phi + turned
