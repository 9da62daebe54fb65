"""When nobody knows where the robot is: the localiser says so, is silent, is frozen, or contradicts itself. Pure.

Poses that jump back and forth are those of two localisers on one topic, or of one that is lost and does not say so. One
jump is none: a localiser that finds the robot elsewhere corrects itself once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.schemas.messages import PoseEstimate

ALLOWED = 0.15  # m or rad of one correction: noise, and the drift of odometry since the last one
MOST = 0.5  # m or rad that one correction counts
LEAK_PER_S = 0.5  # m or rad
EXCESS = 1.0  # m or rad, thus at least three corrections
MAX_STEP_S = 1.0
UNSEEN_M, UNSEEN_RAD = 0.5, 1.0  # by which odometry may come away, e.g. since a gyroscope drifts while the robot stands


@dataclass(frozen=True, slots=True)
class Doubt:
    """Standard deviations of a pose up to which a robot is driven by it."""

    max_std_m: float = math.inf
    max_std_rad: float = math.inf

    def exceeded(self, var_x: float, var_y: float, var_phi: float) -> str:
        """Which of them a pose with these variances exceeds, as text; empty: none."""
        std_m, std_rad = math.sqrt(max(var_x, var_y)), math.sqrt(var_phi)
        if std_m > self.max_std_m:
            return f"standard deviation of {std_m:.2f} m, beyond pose.max_std_m = {self.max_std_m:g}"
        if std_rad > self.max_std_rad:
            return f"standard deviation of {std_rad:.2f} rad, beyond pose.max_std_rad = {self.max_std_rad:g}"
        return ""


class LocaliserCheck:
    """Corrections of a pose beyond what is allowed, less a leak."""

    def __init__(self) -> None:
        """Nothing was received yet."""
        self._last_ns = 0
        self._excess = [0.0, 0.0]  # m, rad

    def fault(self, seen: PoseEstimate, expected: tuple[float, float, float]) -> str:
        """Take a pose into account; without a stamp it is not judged.

        Args:
          seen: Pose of the localiser.
          expected: The pose that was known for its time: x, y (m), phi (rad).

        Returns:
          Text if its corrections contradict each other.
        """
        if not seen.stamp_ns:
            return ""
        passed_s = min(MAX_STEP_S, max(0.0, 1e-9 * (seen.stamp_ns - self._last_ns)))
        self._last_ns = seen.stamp_ns
        corrections = math.dist((seen.x, seen.y), expected[:2]), abs(math.remainder(seen.phi - expected[2], math.tau))
        self._excess = [
            max(0.0, excess - LEAK_PER_S * passed_s) + max(0.0, min(MOST, correction) - ALLOWED)
            for excess, correction in zip(self._excess, corrections, strict=True)
        ]
        if max(self._excess) <= EXCESS:
            return ""
        self._excess = [0.0, 0.0]
        return "jumps back and forth, expected one localiser"


class FrozenCheck:
    """Where odometry was when the localiser's pose last changed.

    One that is frozen, but stamps its poses anew or not at all, would hold the pose in its place while the robot moves.
    """

    def __init__(self) -> None:
        """Nothing was received yet."""
        self._seen: tuple[float, ...] = ()
        self._there = (0.0, 0.0, 0.0)

    def fault(self, seen: PoseEstimate, odometry: tuple[float, float, float]) -> str:
        """Take a pose into account.

        Args:
          seen: Pose of the localiser; its stamp does not count.
          odometry: That of its time: x, y (m), phi (rad).

        Returns:
          Text if it repeats itself although the robot has moved.
        """
        pose = (seen.x, seen.y, seen.phi)
        if pose != self._seen:
            self._seen, self._there = pose, odometry
        away_m = math.dist(self._there[:2], odometry[:2])
        away_rad = abs(math.remainder(odometry[2] - self._there[2], math.tau))
        if away_m <= UNSEEN_M and away_rad <= UNSEEN_RAD:
            return ""
        return "repeats itself to the last digit while odometry moves: the localiser is frozen"
