"""Odometry that contradicts itself, or the commands. Pure.

It may move more than its own speeds say: that of two publishers on one topic, or of false speeds. Two publishers a
hand's breadth apart are no jump, but the robot would be believed at either place in turn. Or it repeats itself while
the robot moves, as one that is frozen and has no stamps, or new ones.
"""

from __future__ import annotations

import math

from tailor.schemas.messages import Odometry

FACTOR = 1.6  # of its speed, as of the limits of speed beyond which the executive takes odometry for none
SLACK_MPS, SLACK_RADPS = 0.5, 0.5  # more: a filter corrects odometry now and then
EXCESS_M, EXCESS_RAD = 1.0, 1.0
MAX_STEP_S = 1.0  # a silence explains no longer way
UNSEEN_M, UNSEEN_RAD = 0.3, 0.5  # of motion without another digit; it may have come to rest against a wall
SLOW_MPS, SLOW_RADPS = 0.05, 0.1  # less may be noise, or too little for the motors to begin to turn
DEAD_S = 1.0  # from a command to the first motion; also of a base that releases its brakes first
MAX_WAIT_S = 0.3  # from message to message, each of which says where the robot was since the last one


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


class RepetitionCheck:
    """Way and turn that the robot makes, by odometry's own speeds or by the commands, while odometry repeats itself.

    That of a robot at rest repeats itself as well: only motion counts.
    """

    def __init__(self) -> None:
        """Nothing was received yet."""
        self._last: tuple[float, ...] = ()
        self._last_s = self._commanded_s = 0.0
        self._unseen = [0.0, 0.0]  # m, rad

    def fault(self, odometry: Odometry, command: tuple[float, float], now_s: float) -> str:
        """Take odometry into account.

        Args:
          odometry: The newest; its stamp does not count.
          command: v (m/s) and omega (rad/s) that the base has been sent last.
          now_s: Monotonic time of its arrival.

        Returns:
          Text if the robot moves and odometry does not show it, or it does not obey.
        """
        last, self._last = self._last, (odometry.x, odometry.y, odometry.phi, odometry.v, odometry.omega)
        passed_s, self._last_s = min(MAX_WAIT_S, now_s - self._last_s), now_s
        commanded = _motion(command)
        self._commanded_s = self._commanded_s + passed_s if any(commanded) and last == self._last else 0.0
        speeds = _motion((odometry.v, odometry.omega))
        if self._commanded_s > DEAD_S:
            speeds = tuple(map(max, speeds, commanded))
        if last != self._last or not any(speeds):
            self._unseen = [0.0, 0.0]
        else:
            self._unseen = [unseen + speed * passed_s for unseen, speed in zip(self._unseen, speeds, strict=True)]
        if self._unseen[0] <= UNSEEN_M and self._unseen[1] <= UNSEEN_RAD:
            return ""
        self._unseen = [0.0, 0.0]
        return "repeats itself to the last digit while the robot is to move: it is frozen, or the base does not obey"


def _motion(velocity: tuple[float, float]) -> tuple[float, ...]:
    """Speeds, m/s and rad/s; 0 for those that are too slow to count."""
    return tuple(
        abs(each) if abs(each) > slow else 0.0 for each, slow in zip(velocity, (SLOW_MPS, SLOW_RADPS), strict=True)
    )
