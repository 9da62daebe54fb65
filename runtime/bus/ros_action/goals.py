"""What became of the goals that clients of the action sent: at most one is open."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from tailor.runtime.bus.followed_goal import FollowedGoal
from tailor.schemas.messages import ExecStatus
from tailor.schemas.ros2.action_messages import ANY_GOAL, CancelCode, GoalInfo, GoalResult, GoalState

UNKNOWN = GoalResult("")
KEPT = 16  # goals that have ended, whose clients may still request the result


@dataclass(slots=True)
class ClientGoal:
    """One goal, and what became of it."""

    info: GoalInfo
    state: GoalState = GoalState.EXECUTING
    result: GoalResult = UNKNOWN
    followed: FollowedGoal = field(default_factory=FollowedGoal)

    @property
    def open(self) -> bool:
        """Whether it is pursued."""
        return self.state in (GoalState.EXECUTING, GoalState.CANCELING)


class ClientGoals:
    """The goals by their clients' ids; what ended earlier comes earlier."""

    def __init__(self) -> None:
        self._goals: dict[bytes, ClientGoal] = {}

    def __iter__(self) -> Iterator[ClientGoal]:
        return iter(self._goals.values())

    def __len__(self) -> int:
        return len(self._goals)

    def get(self, goal: bytes) -> ClientGoal | None:
        """The goal with this id, if it is known."""
        return self._goals.get(goal)

    @property
    def pursued(self) -> ClientGoal | None:
        """The open goal."""
        return next((goal for goal in self if goal.open), None)

    def accept(self, goal: GoalInfo) -> None:
        """The executive pursues a goal from now on; another one that was open is replaced."""
        self.end(GoalResult("replaced"))
        self._goals[goal.id] = ClientGoal(goal)

    def abort(self, goal: GoalInfo, result: GoalResult) -> None:
        """The executive does not pursue a goal; its client reads the cause in the result."""
        self._keep(ClientGoal(goal, GoalState.ABORTED, result))

    def to_cancel(self, named: GoalInfo) -> tuple[CancelCode, ClientGoal | None]:
        """The open goal if a request to cancel means it, else why not."""
        pursued = self.pursued
        is_old = pursued is not None and pursued.info.stamp_ns <= named.stamp_ns  # all until then are meant
        if pursued is not None and (is_old or named.id == pursued.info.id or named == GoalInfo(ANY_GOAL, 0)):
            return CancelCode.NONE, pursued
        if named.id == ANY_GOAL or named.stamp_ns:
            return CancelCode.NONE, None  # as rcl_action has it: that none is so old is no error
        known = named.id in self._goals
        return (CancelCode.GOAL_TERMINATED if known else CancelCode.UNKNOWN_GOAL_ID), None

    def report(self, status: ExecStatus) -> bool:
        """Take the executive's status after a tick; returns whether the open goal has ended."""
        goal = self.pursued
        result = None if goal is None else goal.followed.hear(status)
        return result is not None and self.end(result)

    def end(self, result: GoalResult) -> bool:
        """End the open goal, if there is one; returns whether there was."""
        goal = self.pursued
        if goal is None:
            return False
        if result.result == "cancelled" and goal.state is GoalState.CANCELING:
            goal.state = GoalState.CANCELED
        else:
            goal.state = GoalState.SUCCEEDED if result.result == "achieved" else GoalState.ABORTED
        goal.result = replace(result, duration_s=goal.followed.lasted_s)
        self._keep(goal)
        return True

    def _keep(self, goal: ClientGoal) -> None:
        """Keep a goal that has ended; those that ended first are forgotten."""
        self._goals.pop(goal.info.id, None)
        self._goals[goal.info.id] = goal
        ended = [each.info.id for each in self if not each.open]
        for old in ended[: max(len(ended) - KEPT, 0)]:
            del self._goals[old]
