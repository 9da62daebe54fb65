"""Runs a whole system: the router in this process; simulator, recorder and executive as child processes."""

from __future__ import annotations

import secrets
import socket
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.runtime.bus.attachment import SENDER_BYTES
from tailor.runtime.bus.inbox import Inbox
from tailor.runtime.bus.opening import open_router
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.loop import Loop
from tailor.runtime.processes.child import Child, tailor
from tailor.runtime.processes.supervisor import ProcessSpec, Supervisor
from tailor.runtime.stopping import Stop
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.reason_text import reason_text, result_text
from tailor.tools.cli.live_status import Screen
from tailor.tools.launch.own_executive import OwnExecutive

PERIOD_NS = 50_000_000
SILENCE_NS = 1_000_000_000  # faults.md, row 2
START_S = 20.0


@dataclass(frozen=True, slots=True)
class LaunchConfig:
    """Configuration of one system."""

    executive: ExecutiveConfig
    endpoint: str
    record: Path | None = None  # MCAP file to write
    once: bool = False  # end when the goal is achieved or has failed
    deployment_file: str = ""  # passed on to the executive


def run_system(config: LaunchConfig, screen: Screen, stop: Stop) -> str:
    """Start all processes in order, supervise them, and stop them in the reverse order.

    Returns:
      Result of the executive: "achieved", "failed: " with a reason, or "" if it was stopped.

    Raises:
      UsageError: Bad configuration; no process has been started.
    """
    if config.record is not None and config.record.exists():
        raise UsageError(f"{config.record}: exists already, expected the name of a new file")
    robot = build_context(config.executive, sender="").domain.robot
    with open_router(config.endpoint) as session, tempfile.TemporaryFile("w+") as log:
        supervisor = Supervisor(screen.report, lambda name, argv: Child(name, argv, log))
        try:
            return _run(config, robot, session, supervisor, screen, stop)
        finally:
            supervisor.stop()
            log.seek(0)
            for line in log.read().splitlines():
                screen.report(line)


def free_endpoint() -> str:
    """Unused loopback endpoint, for a system that must not meet another one."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


def _run(config: LaunchConfig, robot: str, session: Session, supervisor: Supervisor, screen: Screen, stop: Stop) -> str:
    inbox = session.inbox(("driver", "status", "tick", "finished", "plan", "subgoals"), robot, newest_only=False)
    if config.record is not None:
        provenance = session.publisher("provenance", robot)  # only the recorder subscribes to this topic
        supervisor.start(ProcessSpec("record", _record(config), restarts=False), time.monotonic_ns())
        if not _wait_until_ready(supervisor, "record", provenance.matched, stop):
            return "failed: the recorder did not start"
    leave = secrets.token_hex(SENDER_BYTES)  # a restarted executive or driver has none
    supervisor.start(ProcessSpec("sim", _sim(config, robot), first_argv=("--leave", leave)), time.monotonic_ns())
    if not _wait_until_ready(supervisor, "sim", lambda: any(s.key == f"{robot}/driver" for s in inbox.drain()), stop):
        return "failed: the simulator did not start"
    executive = ProcessSpec("executive", _executive(config), silence_ns=SILENCE_NS, first_argv=("--sender", leave))
    supervisor.start(executive, time.monotonic_ns())
    return _supervise(config, inbox, supervisor, screen, stop)


def _supervise(config: LaunchConfig, inbox: Inbox, supervisor: Supervisor, screen: Screen, stop: Stop) -> str:
    loop = Loop(PERIOD_NS, MonotonicClock())
    own, result, stopped = OwnExecutive(), "", ""
    while not stop.requested:
        period = loop.wait_for_next_period()
        for sample in inbox.drain():
            if isinstance(sample.message, DriverState):
                stopped = _stopped(sample.message)
            elif own.sent(sample, supervisor.pid("executive")):
                supervisor.report_alive("executive", period.now_ns)
                screen.show(sample.message)
                if isinstance(sample.message, ExecStatus):
                    status = sample.message
                    result = result_text(status.result, status.result_reason, status.result_detail)
        supervisor.poll(period.now_ns)
        ended = _ended(supervisor) or (config.once and (result or stopped))
        if ended:
            return ended
    return result


def _ended(supervisor: Supervisor) -> str:
    """Failure if a required process has ended for good, or ""."""
    ended = [name for name in ("sim", "executive") if supervisor.ended(name) is not None]
    return f"failed: {ended[0]} ended" if ended else ""


def _stopped(driver: DriverState) -> str:
    """Failure if the driver has stopped until it is armed again, or ""."""
    if driver.mode not in ("stopped", "estopped"):
        return ""
    return f"failed: the driver is {driver.mode}: {reason_text(driver.reason, driver.detail)}"


def _wait_until_ready(supervisor: Supervisor, name: str, ready: Callable[[], bool], stop: Stop) -> bool:
    """Wait until a process is ready; False if it ends, after START_S, or on a stop request."""
    deadline = time.monotonic() + START_S
    while not ready():
        supervisor.poll(time.monotonic_ns())
        if stop.requested or time.monotonic() > deadline or supervisor.ended(name) is not None:
            return False
        time.sleep(0.02)
    return True


def _sim(config: LaunchConfig, robot: str) -> list[str]:
    executive = config.executive
    scene = ("--scenario", executive.scenario, "--seed", str(executive.settings.seed))
    return tailor("sim", robot, *scene, "--connect", config.endpoint)


def _record(config: LaunchConfig) -> list[str]:
    return tailor("record", "--output", str(config.record), "--connect", config.endpoint)


def _executive(config: LaunchConfig) -> list[str]:
    executive = config.executive
    flags = ["--scenario", executive.scenario, "--seed", str(executive.settings.seed), "--connect", config.endpoint]
    flags += ["--horizon", str(executive.settings.refinement.horizon)]
    flags += ["--planner", executive.settings.external.command]
    flags += ["--config", config.deployment_file] if config.deployment_file else []
    flags += ["--zoo", executive.zoo] if executive.zoo else []
    return tailor("executive", executive.domain, *flags)
