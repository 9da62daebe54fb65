"""Cost and loss of recording: CPU share, memory, loss after kill -9, lateness of a replay, speed of verify."""

from __future__ import annotations

import json
import os
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from tailor.runtime.bus.opening import open_router
from tailor.runtime.bus.session import Session
from tailor.runtime.processes.child import Child, stopped_in_order, tailor
from tailor.runtime.recordings.recording import Recorded, open_recording
from tailor.schemas.errors import UsageError
from tailor.tools.benchmarks.command_answer import answer
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.traffic import traffic
from tailor.tools.launch.hosting import free_endpoint

RATE_HZ = 400.0
START_S = 15.0
RUN_S = 120.0  # limit of a soccer run
CLOCK_HZ = os.sysconf("SC_CLK_TCK")


def run(console: Console, quick: bool) -> None:
    """Print one row for each quantity.

    Raises:
      NoMeasurement: The recorder has not started, or a run was not recorded.
    """
    table = Table("quantity", "value", title="recording")
    with tempfile.TemporaryDirectory() as folder:
        place, endpoint = Path(folder), free_endpoint()
        with open_router(endpoint) as session:
            _cost(table, session, endpoint, place, 10 if quick else 60)
            _loss(table, session, endpoint, place, 5 if quick else 20)
            for rate in (1, 4):
                _replay(table, session, endpoint, place / "cost.mcap", rate)
        _soccer(table, place / "soccer.mcap")
    console.print(table)


def _recorder(endpoint: str, path: Path) -> Child:
    """A recorder that is ready."""
    command = tailor("record", "--quiet", "-o", str(path), "--connect", endpoint)
    child, deadline = Child("record", command, notify_folder=path.parent), time.monotonic() + START_S
    while not child.report().ready:
        if child.exit_code() is not None or time.monotonic() > deadline:
            child.stop()
            raise NoMeasurement(f"no recorder after {START_S:.0f} s")
        time.sleep(0.02)
    return child


def _cost(table: Table, session: Session, endpoint: str, place: Path, seconds: float) -> None:
    path = place / "cost.mcap"
    with stopped_in_order([_recorder(endpoint, path)]) as (child,), traffic(session, RATE_HZ):
        time.sleep(1.0)
        cpu_s, began = _cpu_s(child.pid), time.monotonic()
        time.sleep(seconds)
        share = (_cpu_s(child.pid) - cpu_s) / (time.monotonic() - began)
        memory = _memory_mb(child.pid)
    kept = list(open_recording(path).messages())
    if not kept:
        raise NoMeasurement("the recorder has recorded no message")
    table.add_row(f"recorder at {RATE_HZ:.0f} msg/s: CPU share of one core", f"{share:.1%}")
    table.add_row("  memory", f"{memory:.0f} MB")
    table.add_row(
        "  file", f"{path.stat().st_size / len(kept):.0f} bytes for each message of {len(kept[0].data)} bytes"
    )
    missing = sum(_missing(kept, key) for key in {message.key for message in kept})
    table.add_row("  lost", f"{missing} of {len(kept) + missing}")


def _missing(kept: Sequence[Recorded], key: str) -> int:
    """Number of messages of one topic that are missing, from the gaps in its sequence numbers."""
    numbers = [message.sequence for message in kept if message.key == key]
    return max(numbers) - min(numbers) + 1 - len(numbers)


def _loss(table: Table, session: Session, endpoint: str, place: Path, tries: int) -> None:
    losses, phases = [], np.random.default_rng(0)
    with traffic(session, RATE_HZ):
        for number in range(tries):
            path = place / f"loss{number}.mcap"
            child = _recorder(endpoint, path)
            time.sleep(2.0 + phases.uniform(0.0, 1.0))
            killed_ns = time.time_ns()
            child.kill()
            kept = [message.log_ns for message in open_recording(path).messages()]
            if not kept:
                raise NoMeasurement(f"the recorder that was killed in try {number + 1} has written no message")
            losses.append((killed_ns - max(kept)) / 1e9)
    table.add_row(
        f"lost by kill -9 of the recorder, {tries} tries", f"max {max(losses):.2f} s, mean {np.mean(losses):.2f} s"
    )


def _replay(table: Table, session: Session, endpoint: str, path: Path, rate: int) -> None:
    command = tailor("replay", str(path), "--rate", str(rate), "--duration", str(10 * rate), "--wait", "0", "--json")
    replayed, _ = answer(f"the replay at rate {rate}", [*command, "--connect", endpoint])
    if not replayed["messages"]:
        raise NoMeasurement(f"the replay at rate {rate} has published no message")
    late = replayed["lateness"]
    table.add_row(
        f"replay at rate {rate}, {RATE_HZ * rate:.0f} msg/s: late",
        f"p50 {late['p50_ms']:.2f} ms, p99 {late['p99_ms']:.2f} ms, max {late['max_ms']:.2f} ms",
    )


def _soccer(table: Table, path: Path) -> None:
    """One recorded run of the whole system: its size, and the speed of its verification."""
    command = tailor("up", "soccer", "--connect", free_endpoint(), "--record", str(path), "--once")
    with tempfile.TemporaryFile("w") as log, stopped_in_order([Child("up", command, log)]) as (child,):
        child.wait(RUN_S)
    try:
        messages = list(open_recording(path).messages())
    except UsageError as error:
        raise NoMeasurement(f"no soccer run was recorded: {error}") from error
    if not messages:
        raise NoMeasurement("the recording of the soccer run is empty")
    seconds = (messages[-1].log_ns - messages[0].log_ns) / 1e9
    table.add_row("size of a soccer run", f"{path.stat().st_size / 1e6 / seconds * 60:.2f} MB a minute")
    for name, options in (("verify", ()), ("verify without proofs", ("--without-proofs",))):
        began = time.monotonic()
        command = tailor("verify", str(path), "--json", *options)
        (verdict, *_), code = answer(name, command)
        with_start_s = time.monotonic() - began
        if not verdict.get("ticks"):
            raise NoMeasurement(f"{name} has compared no tick: {json.dumps(verdict)[:200]}")
        run_s = verdict["ticks"] / 10
        speeds = f"{run_s / verdict['took_s']:.0f} times real time, {run_s / with_start_s:.0f} with start-up"
        table.add_row(f"{name}, a run of {run_s:.0f} s", f"{speeds} (exit {code})")


def _cpu_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / CLOCK_HZ


def _memory_mb(pid: int) -> float:
    status = Path(f"/proc/{pid}/status").read_text()
    return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS")) / 1000
