"""Simulation of a work's parts on any number of workers."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Overheads:
    """Measured costs of a cluster, in seconds.

    Attributes:
      start_s: Of each worker, once: it loads the code and compares its software.
      part_s: Of each part beside its work: sent, started, its result returned.
      write_s: Of each part at the command, which writes one result after another.
    """

    start_s: float
    part_s: float
    write_s: float


def makespan_s(parts_s: Sequence[float], workers: int, overheads: Overheads) -> float:
    """Duration of a work: each part goes to the first free worker, its result waits to be written.

    Returns:
      Seconds from the start of the workers to the last written result.
    """
    free = [overheads.start_s] * workers
    results = []
    for part_s in parts_s:
        done = free[0] + part_s + overheads.part_s
        heapq.heapreplace(free, done)
        results.append(done)
    written = 0.0
    for done in sorted(results):
        written = max(written, done) + overheads.write_s
    return written


def speedup(parts_s: Sequence[float], workers: int, overheads: Overheads) -> float:
    """How much faster than one process of one machine, which has no overheads but those of writing."""
    alone_s = sum(parts_s) + overheads.write_s * len(parts_s)
    return alone_s / makespan_s(parts_s, workers, overheads)
