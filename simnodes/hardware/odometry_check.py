"""Odometry that moves more than its own speeds say: that of two publishers on one topic, or of false speeds. Pure.

Two publishers a hand's breadth apart are no jump, but the robot would be believed at either place in turn.
"""

from __future__ import annotations

import math

from tailor.schemas.messages import Odometry

FACTOR = 1.6  # of its speed, as of the limits of speed beyond which the executive takes odometry for none
SLACK_MPS, SLACK_RADPS = 0.5, 0.5  # more: a filter corrects odometry now and then
EXCESS_M, EXCESS_RAD = 1.0, 1.0
MAX_STEP_S = 1.0  # a silence explains no longer way


class OdometryCheck:
    """Way and turn of one topic that its speeds do not explain, less what is allowed for."""

    def __init__(self) -> None:
        """Nothing was received yet."""
        self._last: Odometry | None = None
        self._excess_m = self._excess_rad = 0.0

    def fault(self, odometry: Odometry) -> str:
        """Take odometry into account; without stamps it is not judged.

        Returns:
          Text if more than one publisher must have sent it, or its speeds are false.
        """
        last, self._last = self._last, odometry
        if last is None or not (last.stamp_ns and odometry.stamp_ns):
            return ""
        passed_s = min(MAX_STEP_S, max(0.0, 1e-9 * (odometry.stamp_ns - last.stamp_ns)))
        step_m = math.dist((last.x, last.y), (odometry.x, odometry.y))
        turn_rad = abs(math.remainder(odometry.phi - last.phi, math.tau))
        speed = max(abs(last.v), abs(odometry.v))
        turning = max(abs(last.omega), abs(odometry.omega))
        self._excess_m = max(0.0, self._excess_m + step_m - (FACTOR * speed + SLACK_MPS) * passed_s)
        self._excess_rad = max(0.0, self._excess_rad + turn_rad - (FACTOR * turning + SLACK_RADPS) * passed_s)
        if self._excess_m <= EXCESS_M and self._excess_rad <= EXCESS_RAD:
            return ""
        self._excess_m = self._excess_rad = 0.0
        return "moves more than its own speeds say, expected one publisher, with true speeds"
