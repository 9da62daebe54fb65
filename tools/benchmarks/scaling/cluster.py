"""What workers of a cluster gain in gathering: simulated from measured times of parts, and overheads of Dask.

Parts and writing are measured in CPU time. The overheads are measured in wall time, on a scheduler and a worker of this
machine; a network adds its latency to each part.
"""

from __future__ import annotations

import itertools
import tempfile
import time
from pathlib import Path

from rich.console import Console
from rich.table import Table

from tailor.executive import domains
from tailor.models.episodes.episodes import store_part
from tailor.schemas.installed import domain_names
from tailor.tools.benchmarks.scaling.simulation import Overheads, speedup
from tailor.tools.learning.gathering import random_episodes
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec
from tailor.tools.learning.gathering.run_data_sets import modelled_actions
from tailor.tools.parallel.cluster import working_on
from tailor.tools.parallel.pool import completed
from tailor.tools.parallel.software import Work

WORKERS = (2, 4, 8, 16, 32, 64)
WORK_PARTS = 1500  # parts of the simulated work: 30000 episodes
ROUNDS = 40  # empty parts, by which the overheads are measured
LOOPBACK = {"dashboard_address": "127.0.0.1:0", "worker_dashboard_address": "127.0.0.1:0"}  # pages with logs


def run(console: Console, quick: bool) -> None:
    """Print one row for each action."""
    table = Table("action", "part", *(f"{count} workers" for count in WORKERS), title=f"speed-up, {WORK_PARTS} parts")
    for name in domain_names():
        measured = {action: _measured(name, action, 2 if quick else 8) for action in modelled_actions(name)}
        parts, _ = next(iter(measured.values()))
        overheads = Overheads(*_overheads_s(name, parts[0]), _write_s(parts[0]))
        robot = domains.load(name).robot
        for action, (_, sizes_s) in measured.items():
            work = list(itertools.islice(itertools.cycle(sizes_s), WORK_PARTS))
            gains = (f"{speedup(work, count, overheads):.1f}" for count in WORKERS)
            table.add_row(f"{robot}/{action}", f"{sum(sizes_s) / len(sizes_s):.2f} s", *gains)
        console.print(
            f"{robot}: start of a worker {overheads.start_s:.1f} s; beside its work, each part takes "
            f"{1e3 * overheads.part_s:.0f} ms on a worker and {1e3 * overheads.write_s:.1f} ms to be written"
        )
    console.print(table)


def _measured(domain: str, action: str, count: int) -> tuple[list[bytes], list[float]]:
    """Parts of a data set, and the CPU time of each."""
    spec = DataSetSpec(domain, action, count * random_episodes.PART, 1, Path())
    random_episodes.part_of(spec, 0)  # loads what any worker loads once
    parts, times_s = [], []
    for first in range(0, spec.episodes, random_episodes.PART):
        started = time.process_time()
        parts.append(random_episodes.part_of(spec, first)[0])
        times_s.append(time.process_time() - started)
    return parts, times_s


def _overheads_s(domain: str, part: bytes) -> tuple[float, float]:
    """Start of a worker, and what a part costs beside its work: its result is sent there and back."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, **LOOPBACK) as cluster:
        started = time.perf_counter()
        with working_on(cluster.scheduler_address, Work((domain,))):
            next(completed(_same, [(part,)], 1))
            ready = time.perf_counter()
            for _ in completed(_same, [(part,)] * ROUNDS, 1):
                pass
            ended = time.perf_counter()
    return ready - started, (ended - ready) / ROUNDS


def _same(part: bytes) -> bytes:
    return part


def _write_s(part: bytes) -> float:
    """CPU time of storing a part."""
    with tempfile.TemporaryDirectory() as folder:
        started = time.process_time()
        for number in range(ROUNDS):
            store_part(Path(folder) / f"part-{number}.parquet", part)
        return (time.process_time() - started) / ROUNDS
