"""Runs a whole system: the router in this process; simulator, recorder and executive as child processes."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from tailor.executive.composition import build_context
from tailor.executive.robot_models import check_models
from tailor.runtime.bus.rights.folder_watch import RunFolderWatch
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.loop import Loop
from tailor.runtime.processes.child import Child
from tailor.runtime.processes.supervised import ProcessSpec, State
from tailor.runtime.processes.supervisor import Supervisor
from tailor.runtime.recordings.new_file import check_new_file
from tailor.runtime.stopping import Stop
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.reason_text import result_text
from tailor.tools.cli.live_status import Screen
from tailor.tools.cli.plain_text import plain
from tailor.tools.launch.arming_advice import DriverLines
from tailor.tools.launch.child_output import ChildOutput
from tailor.tools.launch.goal_advice import next_step
from tailor.tools.launch.hosting import gateways, hosted_bus
from tailor.tools.launch.once import OnceWatch
from tailor.tools.launch.process_reports import ProcessReports
from tailor.tools.launch.processes import (
    LaunchConfig,
    executive_process,
    hardware_process,
    record_process,
    scene_process,
    sim_process,
)
from tailor.tools.launch.recording_watch import RecordingWatch
from tailor.tools.launch.senders import Senders

PERIOD_NS = 50_000_000
EXECUTIVE_TOPICS = ("status", "tick", "finished", "plan", "subgoals")


def run_system(config: LaunchConfig, screen: Screen, stop: Stop) -> str:
    """Start all processes in order, supervise them, and stop them in the reverse order.

    Returns:
      Result of the executive: "achieved", "failed: " with a reason, or "" if it was stopped.

    Raises:
      UsageError: Bad configuration, or there was no robot since its process has refused its input; none has moved.
    """
    check_models(build_context(config.executive, sender=""))  # both report all that is wrong with it
    if config.record is not None:
        check_new_file(config.record)
    with (
        hosted_bus(config.bus, screen.report, 2 + config.scene + (config.record is not None)) as session,
        tempfile.TemporaryFile("w+") as printed,
        tempfile.TemporaryDirectory(prefix="tailor-") as folder,  # of this user alone
    ):
        supervisor = Supervisor(screen.report, lambda name, argv: Child(name, argv, printed, Path(folder)))
        output = ChildOutput(printed, screen.report)
        try:
            return _System(config, session, supervisor, output, screen, stop).run()
        finally:
            supervisor.stop()
            output.finish()


class _System:
    """One run of a system; its children are stopped by the caller."""

    def __init__(
        self,
        config: LaunchConfig,
        session: Session,
        supervisor: Supervisor,
        output: ChildOutput,
        screen: Screen,
        stop: Stop,
    ) -> None:
        self._config, self._robot = config, spec_of(config.executive.domain).robot
        self._supervisor, self._output, self._screen, self._stop = supervisor, output, screen, stop
        self._inbox = session.inbox(("driver", *EXECUTIVE_TOPICS), self._robot, newest_only=False)
        self._senders = Senders()
        self._reports = ProcessReports(session.publisher("processes", self._robot), self._senders, screen)
        self._recording = RecordingWatch(config.require_recording, screen.report)
        self._folder = RunFolderWatch(config.bus.endpoint)
        self._once = OnceWatch(config, supervisor.starts)
        self._driver = DriverLines(self._robot, bool(config.hardware), lambda line: screen.report(plain(line)))
        self._result = self._last_step = ""

    def run(self) -> str:
        """Start the recorder, and the others once it is ready; supervise them once the robot is."""
        config, senders = self._config, self._senders
        for gateway in gateways(config.bus):
            self._start(gateway)
        if config.record is not None:
            recorder = record_process(config, senders)
            self._start(recorder)
            if not self._is_ready(recorder.name):
                return self._not_started("recorder")
        if config.scene:  # before the executive, so that it takes no time from its first ticks
            self._start(scene_process(config, senders))
        robot = hardware_process(config, senders) if config.hardware else sim_process(config, senders, self._robot)
        self._start(robot)
        self._start(executive_process(config, senders))  # it loads meanwhile, and waits
        if not self._is_ready(robot.name, beside="executive"):
            if self._supervisor.state(robot.name) is State.STARTING:  # hardware may be awaited for long
                return "" if self._stop.requested else "failed: executive ended"
            failure = self._not_started("driver" if config.hardware else "simulator")
            if failure and self._supervisor.refused(robot.name):  # it has printed why: an extra is missing, say
                raise UsageError(failure)
            return failure
        return self._supervise()

    def _start(self, spec: ProcessSpec) -> None:
        self._supervisor.start(spec, time.monotonic_ns())

    def _is_ready(self, name: str, beside: str = "") -> bool:
        """Wait for a process; False if it ends before it is ready, is not ready in time, or on a stop request.

        Also if the process `beside` it, which starts meanwhile, has ended for good.
        """
        while self._supervisor.state(name) is State.STARTING and not self._stop.requested:
            if beside and self._supervisor.state(beside) is State.ENDED:
                break
            time.sleep(0.02)
            self._poll(time.monotonic_ns())
        return self._supervisor.state(name) is State.RUNNING

    def _not_started(self, what: str) -> str:
        """Failure of a process, or "" if a stop was requested before it was ready."""
        return "" if self._stop.requested else f"failed: the {what} did not start"

    def _supervise(self) -> str:
        loop = Loop(PERIOD_NS, MonotonicClock())
        while not self._stop.requested:
            period = loop.wait_for_next_period()
            self._receive()
            self._poll(period.now_ns)
            ended = self._ended() or (self._config.once and (self._result or self._once.failure()))
            if ended:
                return ended
        return self._result

    def _receive(self) -> None:
        """Take in what the own children publish; messages of strangers do not count."""
        for sample in self._inbox.drain():
            message = sample.message
            if isinstance(message, DriverState):
                if self._senders.sent(sample, self._config.driver):
                    self._once.hear(message)
                    self._driver.hear(message, self._supervisor.starts(self._config.driver))
            elif self._senders.sent(sample, "executive"):
                self._screen.show(message)
                if isinstance(message, ExecStatus):
                    self._once.hear_executive(message)
                    self._take_result(message)

    def _take_result(self, status: ExecStatus) -> None:
        self._result = result_text(status.result, status.result_reason, status.result_detail)
        line = next_step(status, self._result)
        if line and line != self._last_step and not self._config.once:
            self._screen.report(plain(line))
        self._last_step = line

    def _poll(self, now_ns: int) -> None:
        self._output.poll()  # first: why a child has ended, then that it has
        self._supervisor.poll(now_ns)
        self._reports.publish(self._supervisor.states(now_ns), now_ns)

    def _ended(self) -> str:
        """Failure if a required process has ended for good, or nobody can stop the robot from a shell, or ""."""
        for name in (self._config.driver, "executive"):
            if self._supervisor.state(name) is State.ENDED:
                return f"failed: {name} ended"
        if failure := self._folder.failure():
            return failure
        if self._config.record is None:
            return ""
        return self._recording.failure(
            self._supervisor.state("record") is State.ENDED, self._supervisor.status("record")
        )
