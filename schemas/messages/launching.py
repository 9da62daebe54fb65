"""State of the processes that a launcher supervises."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class ProcessState:
    """One supervised process."""

    name: str
    pid: int  # of the current or last child
    state: str  # starting, running, waiting (for its next start), ended
    starts: int  # first one included
    silent_s: float  # since its last report, or its start; 0 unless it runs
    status: str  # what it reported last, e.g. "disk: No space left on device"
    sender: str  # its sender id on the bus, 32 hex digits; another one after each start


@dataclass(frozen=True, slots=True)
class ProcessStates(Message):
    """All processes of a launcher, in the order of their first starts."""

    stamp_ns: int
    processes: tuple[ProcessState, ...] = ()
