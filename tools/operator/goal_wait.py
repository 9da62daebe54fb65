"""Waits for what becomes of a goal that people have sent: the executive's states until then, and how it ended. Pure."""

from __future__ import annotations

from tailor.runtime.bus.followed_goal import FollowedGoal
from tailor.schemas.messages import ExecStatus, Sample
from tailor.schemas.reason_text import reason_text
from tailor.schemas.ros2.action_messages import GoalResult

SILENT_S = 2.0  # without a status; an executive that stood still for longer refuses goals, too


class GoalWait:
    """Follows one executive; times are monotonic seconds.

    Attributes:
      result: What became of the goal; None while it is open.
      line: What the executive does or waits for, for people.
    """

    def __init__(self, goal: str = "") -> None:
        """`goal`: as it is sent; empty: that of the scenario."""
        self.result: GoalResult | None = None
        self.line = ""
        self._followed = FollowedGoal(goal)
        self._before: tuple[str, int] | None = None  # sender and tick of the newest status before the acceptance
        self._accepted = False
        self._heard_s = 0.0

    def accept(self, now_s: float) -> None:
        """The executive has accepted the goal; what is heard from now on is about it."""
        self._accepted, self._heard_s = True, now_s

    def hear(self, sample: Sample, now_s: float) -> None:
        """Take a status; that of a tick before the acceptance may tell of the goal before."""
        status = sample.message
        if not isinstance(status, ExecStatus) or self.result is not None:
            return
        if not self._accepted:
            self._before = sample.sender, status.tick
            return
        if self._before is not None and (sample.sender != self._before[0] or status.tick <= self._before[1]):
            return
        self._before = sample.sender, status.tick
        self._heard_s = now_s
        doing = f"{status.mode} {status.action}".strip()
        self.line = f"{doing}: {reason_text(status.reason, status.detail)}" if status.reason else doing
        self.result = self._followed.hear(status)

    def lost(self, now_s: float) -> bool:
        """Whether the executive is silent: it is not known what becomes of the goal. One that starts again has none."""
        return self._accepted and self.result is None and now_s - self._heard_s > SILENT_S
