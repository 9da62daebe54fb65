"""Timing of a live system: executive, simulator and recorder as processes, idle and beside CPU burners."""

from __future__ import annotations

import socket
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from tailor.executive.deliberation.context import PERIOD_NS
from tailor.executive.interfaces.values import Array
from tailor.runtime.bus.opening import open_client
from tailor.runtime.bus.session import Session
from tailor.runtime.processes.child import Child, stopped_in_order, tailor
from tailor.runtime.recordings.recording import open_recording
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ArmRequest, ExecStatus, TickReport, VelocityCommand
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.launch.hosting import free_endpoint

BURNERS = 4
BURN = "while True: pass"
START_S = 30.0
MIN_SHARE = 0.5  # of the ticks of the whole time; with fewer the system was down, or hardly ran


def run(console: Console, quick: bool) -> None:
    """Print one row for each case.

    Raises:
      NoMeasurement: The system has not started, or its recording has no tick or no command.
    """
    seconds = 15 if quick else 60
    table = Table(title=f"{seconds} s of soccer at 10 Hz, ms", caption="p50 / p99 / max")
    for column in ("case", "ticks", "missed", "work", "lateness", "percept to command"):
        table.add_column(column, justify="left" if column == "case" else "right")
    for case, burners in (("idle", 0), (f"{BURNERS} CPU burners", BURNERS)):
        with tempfile.TemporaryDirectory() as folder:
            recording = Path(folder) / "ticks.mcap"
            _drive(recording, seconds, burners)
            table.add_row(case, *_row(recording, round(MIN_SHARE * seconds * 1e9 / PERIOD_NS)))
    console.print(table)


def _drive(recording: Path, seconds: float, burners: int) -> None:
    """Run a system for `seconds`, one episode after another."""
    endpoint = free_endpoint()
    up = tailor("up", "soccer", "--connect", endpoint, "--record", str(recording))
    with tempfile.TemporaryFile("w") as log, stopped_in_order([Child("up", up, log)]) as children:
        wait_for_router(endpoint)
        children += [Child("burner", [sys.executable, "-c", BURN]) for _ in range(burners)]
        with open_client(endpoint, role="people") as session:
            _wait_for_status(session)
            play(session, time.monotonic() + seconds)


def wait_for_router(endpoint: str) -> None:
    """Wait until something listens there; raises NoMeasurement after START_S."""
    host, port = endpoint.removeprefix("tcp/").split(":")
    deadline = time.monotonic() + START_S
    while time.monotonic() < deadline:
        with socket.socket() as probe:
            if probe.connect_ex((host, int(port))) == 0:
                return
        time.sleep(0.05)
    raise NoMeasurement(f"no router at {endpoint} after {START_S} s")


def _wait_for_status(session: Session) -> None:
    """Wait until an executive ticks; raises NoMeasurement after START_S."""
    inbox, deadline = session.inbox(("status",), ""), time.monotonic() + START_S
    while not inbox.drain():
        if time.monotonic() > deadline:
            raise NoMeasurement(f"no executive after {START_S} s")
        time.sleep(0.05)


def play(session: Session, until_s: float) -> None:
    """Reset the world and set the goal again after each episode."""
    inbox, arm = session.inbox(("status",), ""), session.publisher("arm_request", "agilo")
    seed = 0
    while time.monotonic() < until_s:
        for sample in inbox.drain():
            if isinstance(sample.message, ExecStatus) and sample.message.result:
                seed += 1
                session.call("agilo/sim/reset", f'{{"seed": {seed}}}')
                time.sleep(1.5)  # the belief converges again
                arm.publish(ArmRequest(arm=True, reset=False, sender=sample.sender, epoch=0))
                session.call("exec/goal", "")
                time.sleep(0.5)
                inbox.drain()
        time.sleep(0.05)


def _row(recording: Path, min_ticks: int = 1) -> list[str]:
    """Cells of one case: ticks, missed ticks, work, lateness, delay from percept to command; fewer ticks are none."""
    reports, delays = [], []
    sent: dict[int, int] = {}
    percepts: dict[tuple[str, int], int] = {}
    for recorded, message in open_recording(recording).decoded():
        if isinstance(message, Rejected):
            continue
        percepts[recorded.key, recorded.sequence] = recorded.publish_ns
        if isinstance(message, VelocityCommand):
            sent[message.stamp_ns] = recorded.log_ns
        elif isinstance(message, TickReport):
            reports.append(message)
            newest = [
                percepts[named]
                for named in zip(message.input_keys, message.input_sequences, strict=True)
                if named[0].endswith(("/odom", "/pose")) and named in percepts  # the recorder may have lost it
            ]
            if message.stamp_ns in sent and newest:
                delays.append((sent[message.stamp_ns] - max(newest)) / 1e6)
    if len(reports) < min_ticks or not delays:
        found = f"{len(reports)} tick reports and {len(delays)} commands after a percept"
        raise NoMeasurement(f"the recording has {found}, expected at least {min_ticks} ticks")
    work = np.array([report.work_ns for report in reports]) / 1e6
    late = np.array([report.lateness_ns for report in reports]) / 1e6
    missed = sum(report.skipped for report in reports)
    return [str(len(reports)), str(missed), _percentiles(work), _percentiles(late), _percentiles(np.array(delays))]


def _percentiles(values: Array) -> str:
    return f"{np.percentile(values, 50):.2f} / {np.percentile(values, 99):.2f} / {values.max():.2f}"
