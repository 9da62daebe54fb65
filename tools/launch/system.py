"""Runs a whole system: the bus's router in this process; simulator, recorder and executive as its children."""

from __future__ import annotations

import socket
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tailor.executive.composition import ExecutiveConfig, build_context
from tailor.runtime.bus.inbox import Inbox
from tailor.runtime.bus.session import Session, open_router
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

LOOK_NS = 50_000_000
SILENCE_NS = 1_000_000_000  # faults.md, row 2
START_S = 20.0


@dataclass(frozen=True, slots=True)
class LaunchConfig:
    """What to start."""

    order: ExecutiveConfig
    endpoint: str
    record: Path | None = None
    once: bool = False  # end when the goal is achieved or has failed
    config: str = ""


def run_system(plan: LaunchConfig, screen: Screen, stop: Stop) -> str:
    """Start everything in order, watch it, stop everything in the opposite order.

    Returns:
      The executive's result: "achieved", "failed: why", or "" when it was stopped.

    Raises:
      UsageError: Before anything is started.
    """
    if plan.record is not None and plan.record.exists():
        raise UsageError(f"{plan.record}: exists already, expected the name of a new file")
    robot = build_context(plan.order, sender="").domain.robot
    with open_router(plan.endpoint) as session, tempfile.TemporaryFile("w+") as log:
        supervisor = Supervisor(screen.report, lambda name, argv: Child(name, argv, log))
        try:
            return _run(plan, robot, session, supervisor, screen, stop)
        finally:
            supervisor.stop()
            log.seek(0)
            for line in log.read().splitlines():
                screen.report(line)


def free_endpoint() -> str:
    """A loopback endpoint that nobody listens at, for systems that are not to be found."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


def _run(plan: LaunchConfig, robot: str, session: Session, supervisor: Supervisor, screen: Screen, stop: Stop) -> str:
    inbox = session.inbox(("driver", "status", "tick", "finished", "plan", "subgoals"), robot, newest_only=False)
    if plan.record is not None:
        listened = session.publisher("provenance", robot)  # the recorder alone hears that: we do not
        supervisor.start(ProcessSpec("record", _record(plan), restarts=False), time.monotonic_ns())
        if not _appeared(supervisor, "record", listened.matched, stop):
            return "failed: the recorder did not start"
    supervisor.start(ProcessSpec("sim", _sim(plan, robot)), time.monotonic_ns())
    if not _appeared(supervisor, "sim", lambda: any(s.key == f"{robot}/driver" for s in inbox.drain()), stop):
        return "failed: the simulator did not start"
    supervisor.start(ProcessSpec("executive", _executive(plan), silence_ns=SILENCE_NS), time.monotonic_ns())
    return _watch(plan, inbox, supervisor, screen, stop)


def _watch(plan: LaunchConfig, inbox: Inbox, supervisor: Supervisor, screen: Screen, stop: Stop) -> str:
    loop = Loop(LOOK_NS, MonotonicClock())
    own, result, stopped = OwnExecutive(), "", ""
    while not stop.requested:
        turn = loop.wait_for_next_period()
        for sample in inbox.drain():
            if isinstance(sample.message, DriverState):
                stopped = _stopped(sample.message)
            elif own.sent(sample, supervisor.pid("executive")):
                supervisor.report_alive("executive", turn.now_ns)
                screen.show(sample.message)
                if isinstance(sample.message, ExecStatus):
                    status = sample.message
                    result = result_text(status.result, status.result_reason, status.result_detail)
        supervisor.poll(turn.now_ns)
        ended = _ended(supervisor) or (plan.once and (result or stopped))
        if ended:
            return ended
    return result


def _ended(supervisor: Supervisor) -> str:
    """What is missing for good, or ""."""
    dead = [name for name in ("sim", "executive") if supervisor.ended(name) is not None]
    return f"failed: {dead[0]} ended" if dead else ""


def _stopped(driver: DriverState) -> str:
    """Why the robot stands until people arm it again, or ""; nobody is there to do so in a run that is to end."""
    if driver.mode not in ("stopped", "estopped"):
        return ""
    return f"failed: the driver is {driver.mode}: {reason_text(driver.reason, driver.detail)}"


def _appeared(supervisor: Supervisor, name: str, ready: Callable[[], bool], stop: Stop) -> bool:
    """Wait until a process shows that it is there; False if it ends, time runs out, or people stop the system."""
    deadline = time.monotonic() + START_S
    while not ready():
        supervisor.poll(time.monotonic_ns())
        if stop.requested or time.monotonic() > deadline or supervisor.ended(name) is not None:
            return False
        time.sleep(0.02)
    return True


def _sim(plan: LaunchConfig, robot: str) -> list[str]:
    order = plan.order
    scene = ("--scenario", order.scenario, "--seed", str(order.settings.seed))
    return tailor("sim", robot, *scene, "--connect", plan.endpoint)


def _record(plan: LaunchConfig) -> list[str]:
    return tailor("record", "--output", str(plan.record), "--connect", plan.endpoint)


def _executive(plan: LaunchConfig) -> list[str]:
    order = plan.order
    flags = ["--scenario", order.scenario, "--seed", str(order.settings.seed), "--connect", plan.endpoint]
    flags += ["--horizon", str(order.settings.refinement.horizon)]
    flags += ["--planner", order.settings.external.command]
    flags += ["--config", plan.config] if plan.config else []
    flags += ["--zoo", order.zoo] if order.zoo else []
    return tailor("executive", order.domain, *flags)
