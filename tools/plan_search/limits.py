"""Limits of a search from the command line: wall time, and memory that the search takes."""

from __future__ import annotations

import math
import resource
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

MAX_PLANS = 1_000_000  # about 1 GB of memory
GROUND_LIMIT = 300_000  # steps: two seconds of CPU, more than a robot may take
CHECKS_PER_LOOK = 16  # checks of the budget from one look at the memory to the next: 0.4 MB each with 2000 goals


def memory_mb() -> float:
    """Memory of the process; where the system does not report it, the most that it has taken."""
    try:
        return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / 2**20
    except OSError:
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        return peak / 2**20 if sys.platform == "darwin" else peak / 2**10


@dataclass(slots=True)
class Limits:
    """A budget (see `Budget`) that is spent at a deadline, or when the process has grown too much."""

    limit_s: float = math.inf
    limit_mb: float = math.inf
    granted: int = 0
    reached: str = ""  # the limit that was reached, e.g. "2 s"
    interrupted: bool = False
    deadline: float = field(init=False)
    started_mb: float = field(init=False)

    def __post_init__(self) -> None:
        self.deadline = time.monotonic() + self.limit_s
        self.started_mb = memory_mb()

    @property
    def reason(self) -> str:
        """Why a search ended without a plan; empty if no limit was reached."""
        return self._why("no plan")

    @property
    def why_none_better(self) -> str:
        """Why a search with a plan ended; empty if no limit was reached."""
        return self._why("none better")

    def _why(self, missing: str) -> str:
        if self.interrupted:
            return "interrupted"
        return f"{missing} within {self.reached}" if self.reached else ""

    @property
    def left_s(self) -> float:
        """Time until the deadline."""
        return self.deadline - time.monotonic()

    def spent(self) -> bool:
        """See `Budget`."""
        self.granted += 1
        if time.monotonic() >= self.deadline:
            self.reached = f"{self.limit_s:g} s"
        elif self.granted % CHECKS_PER_LOOK == 0 and memory_mb() - self.started_mb > self.limit_mb:
            self.reached = f"{self.limit_mb:g} MB of memory"
        return bool(self.reached)
