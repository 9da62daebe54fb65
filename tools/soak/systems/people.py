"""People who look after a system: they arm it after a stop, once nothing has moved for a while, and set new tasks."""

from __future__ import annotations

import time
from collections.abc import Callable

from tailor.schemas.messages import ArmRequest, EStop, ExecStatus
from tailor.tools.soak.systems.system import System
from tailor.tools.soak.systems.tasks import Tasks

QUIET_NS = 2_000_000_000  # after a stop, before people arm: whatever moves then moves unasked
AGAIN_NS = 2_500_000_000  # between two attempts to arm
FAULT = "FAULT"  # mode of the executive
RESULT_NS = 300_000_000  # after a new goal: what is older belongs to the last one


def has_ended(status: ExecStatus) -> bool:
    """Whether the task needs people: it has a result, or its fault is latched until they set a new goal."""
    return bool(status.result) or status.mode == FAULT


class People:
    """Look after one system; call `attend` many times a second.

    Attributes:
      armed_ns: Time of their last request to arm; 0: none.
      armed_for_task: Whether a task waited for it.
      prepared_ns: Time at which they last prepared a task, which may disarm; 0: never.
      count: Number of tasks that they set.
      faults: Faults of the executive that they cleared with a task: their causes.
    """

    def __init__(self, system: System, tasks: Tasks, now: Callable[[], int] = time.monotonic_ns) -> None:
        """`tasks` are those of the present start; `now` is the monotonic time in nanoseconds."""
        self.armed_ns = self.prepared_ns = self.count = 0
        self.armed_for_task = False
        self._system, self._tasks, self._now = system, tasks, now
        self._executive = ""  # sender id
        self._goal_ns = 0  # a goal is due then; 0: none
        self._set_ns = 0  # time of the last goal
        self.faults: list[str] = []

    def arm(self) -> None:
        """Arm for the executive that runs, with a reset if the e-stop is latched."""
        link = self._system.link
        if link is None or link.view.driver is None or not link.view.sender:
            return
        now_ns = self.armed_ns = self._now()  # a call before it may have taken a second; the leave counts from here
        self.armed_for_task = link.view.status is not None and not has_ended(link.view.status)
        self._system.judge.people_arm(now_ns)
        link.arming.publish(ArmRequest(True, link.view.driver.mode == "estopped", link.view.sender, 0))

    def disarm(self, now_ns: int, zero_within_s: float) -> None:
        """Disarm."""
        self._system.judge.revoke(now_ns, zero_within_s)
        if self._system.link is not None:
            self._system.link.arming.publish(ArmRequest(False, False, "", 0))

    def estop(self, now_ns: int, zero_within_s: float) -> None:
        """Stop every driver."""
        self._system.judge.revoke(now_ns, zero_within_s)
        if self._system.link is not None:
            self._system.link.estop.publish(EStop(True))

    def attend(self) -> None:
        """Do what is due."""
        system, link, now_ns = self._system, self._system.link, self._now()
        if link is None or not system.heard(now_ns):
            return
        view = link.view
        if view.driver is None or view.status is None:
            return
        if view.sender != self._executive:
            self._executive, self._goal_ns = view.sender, self._tasks.begin(now_ns)
        elif has_ended(view.status) and not self._goal_ns and view.status_ns > self._set_ns + RESULT_NS:
            self._goal_ns = self._tasks.prepare(now_ns)
            self.prepared_ns = now_ns if self._goal_ns else self.prepared_ns
            if self._goal_ns and not view.status.result:
                self.faults.append(f"{view.status.reason}: {view.status.detail}")
        if not system.judge.permitted:
            long_ago = now_ns - self.armed_ns > AGAIN_NS
            if long_ago and view.driver.mode != "armed" and system.judge.at_rest_since(now_ns, QUIET_NS):
                self.arm()
        elif self._goal_ns and now_ns > self._goal_ns and view.driver.mode == "armed":
            self.set_goal()

    def set_goal(self) -> None:
        """Set the next goal, also while the last one is pursued."""
        accepted, _ = self._system.call("exec/goal", self._tasks.goal())
        if accepted:
            self._goal_ns, self._set_ns = 0, self._now()
            self.count += 1
