"""Waits for what becomes of a goal that people have sent: the executive's states until then, and how it ended. Pure."""

from __future__ import annotations

from tailor.runtime.bus.followed_goal import FollowedGoal
from tailor.schemas.messages import ExecStatus, Sample
from tailor.schemas.reason_text import reason_text
from tailor.schemas.ros2.action_messages import GoalResult

SILENT_S = 2.0  # without a status; an executive that stood still for longer refuses goals, too
OTHER_S = 1.0  # of the executive heard before the goal: one that ended just then has left the goal to another one


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
        self._goal, self._followed = goal.strip(), FollowedGoal(goal)
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
        if self._before is not None:
            same = sample.sender == self._before[0]
            if not (status.tick > self._before[1] if same else self._took_over(status, now_s)):
                return
        self._before = sample.sender, status.tick
        self._heard_s = now_s
        doing = f"{status.mode} {status.action}".strip()
        self.line = f"{doing}: {reason_text(status.reason, status.detail)}" if status.reason else doing
        self.result = self._followed.hear(status)

    def _took_over(self, status: ExecStatus, now_s: float) -> bool:
        """Whether an executive pursues the goal that the one heard before has not been heard of since."""
        pursued = not status.result and status.goal == (self._goal or status.goal) != ""
        return pursued and not self.line and now_s - self._heard_s > OTHER_S

    def lost(self, now_s: float) -> bool:
        """Whether the executive is silent: it is not known what becomes of the goal. One that starts again has none."""
        return self._accepted and self.result is None and now_s - self._heard_s > SILENT_S
