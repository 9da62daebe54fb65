"""A goal that the executive pursues, followed by its status: for whoever waits for what becomes of it."""

from __future__ import annotations

from dataclasses import replace

from tailor.schemas.messages import ExecStatus
from tailor.schemas.ros2.action_messages import GoalResult


class FollowedGoal:
    """Takes each status since the acceptance, best that of the same tick first.

    Attributes:
      lasted_s: From the first status to the newest.
    """

    def __init__(self, goal: str = "") -> None:
        """`goal`: as it was sent; empty: that of the first status."""
        self._goal = goal.strip()
        self._begun_ns: int | None = None
        self.lasted_s = 0.0

    def hear(self, status: ExecStatus) -> GoalResult | None:
        """What became of the goal; None while it is open."""
        if self._begun_ns is None:
            self._goal, self._begun_ns = self._goal or status.goal, status.stamp_ns
        self.lasted_s = 1e-9 * (status.stamp_ns - self._begun_ns)
        result = _result(self._goal, status)
        return None if result is None else replace(result, duration_s=self.lasted_s)


def _result(goal: str, status: ExecStatus) -> GoalResult | None:
    if status.goal != goal:
        return GoalResult("replaced")
    if status.result:
        return GoalResult(status.result, status.result_reason, status.result_detail)
    return GoalResult("fault", status.reason, status.detail) if status.mode == "FAULT" else None
