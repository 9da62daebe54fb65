"""Whether a robot is at the other ends of its topics: a misspelt name is silent in ROS 2. Pure.

A base that comes later would obey a driver that was armed while nobody heard it: a person must arm that one again.
"""

from __future__ import annotations

ABSENT_S = 1.5  # a base that is heard no more for as long has gone
FIRST_S = 2.0  # from opening to the first odometry; the driver would give no name after 3 s


class OtherEnds:
    """Follows the subscribers of the command, and the first odometry and pose since the topics were opened."""

    def __init__(self, command: str, odometry: str, pose: str, now_s: float) -> None:
        """Nobody was heard yet.

        Args:
          command, odometry, pose: Names of the topics, for people; an empty pose: there is no localiser.
          now_s: Monotonic time of their opening.
        """
        self._command, self._odometry, self._pose = command, odometry, pose
        self._opened_s = self._obeyed_s = now_s
        self._obeyed = self._measured = False

    def obeys(self, matched: bool, now_s: float) -> bool:
        """Whether somebody takes the commands, or has a moment ago.

        Args:
          matched: Whether the command's topic has a subscriber.
          now_s: Monotonic time.

        Raises:
          ValueError: Nobody has for too long.
        """
        if matched:
            self._obeyed, self._obeyed_s = True, now_s
        elif now_s - self._obeyed_s > ABSENT_S:
            raise ValueError(f"{self._command}: nobody takes commands there, expected the base (topics.cmd_vel)")
        return self._obeyed

    def measures(self, measured: bool, now_s: float) -> None:
        """Note whether odometry has come since the last call.

        Raises:
          ValueError: None has come for too long since the opening.
        """
        self._measured = self._measured or measured
        if not self._measured and now_s - self._opened_s > FIRST_S:
            raise ValueError(f"{self._odometry}: nothing comes from there, expected odometry (topics.odom)")

    def unlocated(self, located: bool, may_speak: bool, now_s: float) -> str:
        """Text if no localiser has been heard for a while. That is no fault: many publish only while the robot moves.

        Args:
          located: Whether a pose has ever come.
          may_speak: False if nobody publishes there for certain.
          now_s: Monotonic time.
        """
        if not self._pose or located or now_s - self._opened_s <= FIRST_S:
            return ""
        why = "nothing has come from there yet" if may_speak else "nobody publishes there"
        return f"{self._pose}: {why}, expected the localiser (topics.pose)"
