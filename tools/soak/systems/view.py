"""What a session on the bus sees of one start of a system, and hands to its judge."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.runtime.bus.session import Session
from tailor.schemas.messages import DriverState, ExecStatus, JointCommand, Sample, TickReport, VelocityCommand
from tailor.simnodes.driver import command_values
from tailor.tools.soak.judging.motion import MotionJudge
from tailor.tools.soak.judging.robots import Robot, is_moving, rest_threshold, speeds_of
from tailor.tools.soak.systems.strangers import FORGED_NS, STRANGER

AXES = {"agilo": ("v", "omega"), "powercube": ("pan", "lift")}
TRUTH_S = 0.1  # from one truth to the next


@dataclass(slots=True)
class Totals:
    """Counts over all starts of a system."""

    ticks: int = 0
    skipped: int = 0
    worst_late_ms: float = 0.0
    commands: int = 0
    motion_s: float = 0.0


class View:
    """Newest true messages; those of strangers are left out.

    Attributes:
      status, status_ns: Newest status of the executive, and its arrival.
      driver, driver_ns: Newest state of the driver, and its arrival.
      sender: The executive's id; empty: none has been heard.
    """

    def __init__(self, session: Session, robot: Robot, judge: MotionJudge, totals: Totals) -> None:
        """Subscribe; `judge` and `totals` outlive this start."""
        self.status: ExecStatus | None = None
        self.driver: DriverState | None = None
        self.status_ns = self.driver_ns = 0
        self.sender = ""
        self._robot, self._judge, self._totals = robot, judge, totals
        self._simulator = ""  # its sender id: who alone reports the driver's state
        topics = ("driver", "status", "tick", robot.truth, robot.command)
        self._inbox = session.inbox(topics, robot.name, newest_only=False)

    def poll(self) -> None:
        """Take what has arrived."""
        for sample in self._inbox.drain():
            if not sample.sender.startswith(STRANGER):
                self._take(sample)

    def _take(self, sample: Sample) -> None:
        message, now_ns = sample.message, sample.arrival_ns
        speeds = speeds_of(message)
        if speeds is not None:
            self._simulator = sample.sender
            self._totals.motion_s += TRUTH_S * is_moving(speeds)
            self._judge.truth(now_ns, speeds, rest_threshold(message))
        elif isinstance(message, DriverState):
            if sample.sender == self._simulator:
                self.driver, self.driver_ns = message, now_ns
                self._judge.driver(now_ns, message.mode, message.epoch)
        elif isinstance(message, ExecStatus):
            self.status, self.status_ns, self.sender = message, now_ns, sample.sender
        elif isinstance(message, TickReport):
            self._count(message)
        elif isinstance(message, VelocityCommand | JointCommand) and message.stamp_ns != FORGED_NS:
            self._totals.commands += 1
            self._judge.command(now_ns, command_values(message, AXES[self._robot.name]))

    def _count(self, report: TickReport) -> None:
        totals = self._totals
        totals.ticks += 1
        totals.skipped += report.skipped
        totals.worst_late_ms = max(totals.worst_late_ms, report.lateness_ns / 1e6)
