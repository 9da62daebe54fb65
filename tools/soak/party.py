"""What a soak keeps of its systems, and what it has found."""

from __future__ import annotations

from dataclasses import dataclass, field

from tailor.tools.soak.faults.scene import FaultRecord
from tailor.tools.soak.judging.violations import Violation
from tailor.tools.soak.systems.people import People
from tailor.tools.soak.systems.system import System
from tailor.tools.soak.watch import Watch


@dataclass(slots=True)
class Result:
    """What a soak has found."""

    seed: int
    duration_s: float = 0.0
    records: list[FaultRecord] = field(default_factory=list)
    violations: list[Violation] = field(default_factory=list)
    failed_faults: list[str] = field(default_factory=list)
    worst_stall_s: float = 0.0


@dataclass(slots=True)
class Party:
    """A system, and who looks after it."""

    system: System
    people: People
    watch: Watch
    record: FaultRecord | None = None  # of its last fault
    ending: bool = False
    tasks: int = 0  # set by people
    faults: list[str] = field(default_factory=list)  # causes of those of the executive that people cleared
    stops: int = 0  # of the driver, that nobody caused
