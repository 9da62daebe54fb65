"""Resident memory of each process of a live system, and page faults of the executive's loop."""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import Child, stopped_in_order, tailor
from tailor.tools.benchmarks.no_measurement import NoMeasurement
from tailor.tools.benchmarks.ticks import play, wait_for_router
from tailor.tools.launch.hosting import free_endpoint

SETTLE_S = 10.0  # until every process has started and the loop runs
PROCESSES = ("sim", "record", "executive")


@dataclass(frozen=True, slots=True)
class Usage:
    """Memory of one process."""

    resident_mb: float
    peak_mb: float
    own_mb: float  # of the resident what is no file's, of which the kernel maps more or fewer pages at once
    minor_faults: int  # of its main thread so far: pages found in memory
    major_faults: int  # pages read from the disk

    @classmethod
    def of(cls, pid: int) -> Usage:
        """Usage of a running process; raises OSError if it has ended."""
        lines = Path(f"/proc/{pid}/status").read_text().splitlines()
        kb = {line.split(":")[0]: int(line.split()[1]) for line in lines if line.startswith(("Vm", "Rss"))}
        stat = Path(f"/proc/{pid}/task/{pid}/stat").read_text().rpartition(")")[2].split()
        own_kb = kb["RssAnon"] + kb["RssShmem"]
        return cls(kb["VmRSS"] / 1000, kb["VmHWM"] / 1000, own_kb / 1000, int(stat[7]), int(stat[9]))


def run(console: Console, quick: bool) -> None:
    """Print one row for each process.

    Raises:
      NoMeasurement: A process has not started, or has ended.
    """
    seconds = 15 if quick else 60
    table = Table(
        "process", "resident", "peak", f"growth in {seconds} s", "page faults of its loop", title="memory, MB"
    )
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile("w") as log:
        endpoint = free_endpoint()
        up = tailor("up", "soccer", "--connect", endpoint, "--no-scene", "--record", str(Path(folder) / "memory.mcap"))
        with stopped_in_order([Child("up", up, log)]) as (launcher,):
            wait_for_router(endpoint)
            time.sleep(SETTLE_S)
            pids = {"up": launcher.pid, **processes_of(launcher.pid)}
            before = {name: _usage(name, pid) for name, pid in pids.items()}
            with open_client(endpoint, role="people") as session:
                play(session, time.monotonic() + seconds)
            for name, pid in pids.items():
                table.add_row(name, *_row(before[name], _usage(name, pid)))
    console.print(table)


def processes_of(launcher: int) -> dict[str, int]:
    """Process ids of the children of `tailor up`, by command.

    Raises:
      NoMeasurement: One is missing.
    """
    pids: dict[str, int] = {}
    for task in Path(f"/proc/{launcher}/task").iterdir():
        for pid in map(int, (task / "children").read_text().split()):
            words = Path(f"/proc/{pid}/cmdline").read_text().split("\0")
            pids |= {name: pid for name in PROCESSES if name in words}
    missing = [name for name in PROCESSES if name not in pids]
    if missing:
        raise NoMeasurement(f"not running: {', '.join(missing)}")
    return pids


def _usage(name: str, pid: int) -> Usage:
    try:
        return Usage.of(pid)
    except (OSError, KeyError) as error:
        raise NoMeasurement(f"{name} has ended") from error


def _row(before: Usage, after: Usage) -> list[str]:
    minor, major = after.minor_faults - before.minor_faults, after.major_faults - before.major_faults
    grown = after.resident_mb - before.resident_mb
    return [f"{after.resident_mb:.0f}", f"{after.peak_mb:.0f}", f"{grown:+.1f}", f"{minor} minor, {major} major"]
