"""Invariants of the processes of one system, and their memory; checked once a second, sampled each five."""

from __future__ import annotations

from tailor.tools.soak.judging.motion import Report
from tailor.tools.soak.judging.violations import Invariant
from tailor.tools.soak.systems import processes
from tailor.tools.soak.systems.system import CHILDREN, System

CHECK_NS = 1_000_000_000
MEMORY_NS = 5_000_000_000
ABSENT_NS = 8_000_000_000  # restarts come after 0.2 s, doubled for each within a minute
STARTING_NS = 20_000_000_000  # processes start one after another
STILL_NS = 30_000_000_000  # people need 5 s for a new task, a busy machine longer

Samples = list[tuple[float, float]]  # s, MB


class Watch:
    """Watches one system; call `poll` many times a second.

    Attributes:
      memory: Own resident memory of each process, without pages of files, by name and process id.
      launcher_gone: The launcher has ended although nobody wanted it to.
    """

    def __init__(self, system: System, report: Report) -> None:
        """`report` receives violations."""
        self.memory: dict[tuple[str, int], Samples] = {}
        self.launcher_gone = False
        self._system, self._report = system, report
        self._checked_ns = self._sampled_ns = 0
        self._present_ns: dict[str, int] = {}
        self._reported: set[str] = set()
        self._active_ns = 0

    def started(self, now_ns: int) -> None:
        """The system has been started, or started again."""
        self._present_ns = dict.fromkeys(CHILDREN, now_ns + STARTING_NS)
        self._active_ns = now_ns + STARTING_NS
        self._reported.clear()
        self.launcher_gone = False

    def poll(self, now_ns: int) -> None:
        """Check and sample what is due."""
        if now_ns - self._checked_ns < CHECK_NS:
            return
        self._checked_ns = now_ns
        found = self._system.pids()
        self.launcher_gone = not found
        self._check_children(now_ns, found)
        self._check_motion(now_ns)
        if now_ns - self._sampled_ns >= MEMORY_NS:
            self._sampled_ns = now_ns
            for name, pids in found.items():
                for pid in pids:
                    self._sample(now_ns, name, pid)

    def _check_children(self, now_ns: int, found: dict[str, list[int]]) -> None:
        for name in CHILDREN:
            count = len(found.get(name, []))
            if count:
                self._present_ns[name] = max(now_ns, self._present_ns[name])
            if count > 1:
                self._once(now_ns, name, f"{count} processes of {name}")
            elif now_ns - self._present_ns[name] > ABSENT_NS:
                self._once(now_ns, name, f"{name} is absent for {ABSENT_NS // 10**9} s")

    def _check_motion(self, now_ns: int) -> None:
        if self._idle():
            self._active_ns = max(now_ns, self._active_ns)
        active_ns = max(self._active_ns, self._system.judge.moved_ns)
        if now_ns - active_ns > STILL_NS:
            self._active_ns = now_ns
            self._report(
                now_ns, Invariant.TASK_GOES_ON, f"nothing has moved for {STILL_NS // 10**9} s; {self._state()}"
            )

    def _idle(self) -> bool:
        """Whether the robot is armed, and its task has ended: nothing needs to move."""
        link = self._system.link
        if link is None or link.view.driver is None or link.view.status is None:
            return False
        return link.view.driver.mode == "armed" and bool(link.view.status.result)

    def _state(self) -> str:
        link = self._system.link
        if link is None:
            return "no connection"
        driver, status = link.view.driver, link.view.status
        return (
            f"driver {driver and (driver.mode, driver.reason)}, "
            f"executive {status and (status.mode, status.reason, status.detail, status.result)}"
        )

    def _sample(self, now_ns: int, name: str, pid: int) -> None:
        size_mb = processes.own_mb(pid)
        if size_mb is not None:
            self.memory.setdefault((name, pid), []).append((now_ns / 1e9, size_mb))

    def _once(self, now_ns: int, name: str, detail: str) -> None:
        if name not in self._reported:
            self._reported.add(name)
            self._report(now_ns, Invariant.CHILDREN, detail)
