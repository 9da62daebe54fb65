"""Reads a recording once and counts: streams, gaps, modes, actions, results, tick timing. Prints nothing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from tailor.runtime.recordings.recording import Recorded, Recording
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ActionFinished, DriverState, ExecStatus, TickReport
from tailor.schemas.reason_text import reason_text, result_text
from tailor.schemas.typesystem import type_of


@dataclass(slots=True)
class Stream:
    """The messages of one key and sender."""

    key: str
    ros_type: str
    sender: str
    count: int = 0
    bytes: int = 0
    first_ns: int = 0
    last_ns: int = 0
    lost: int = 0  # sequence numbers that are missing between two that are there
    longest_gap_ns: int = 0
    rejected: Counter[str] = field(default_factory=Counter)
    _sequence: int = 0

    @property
    def rate_hz(self) -> float:
        """Mean rate between the first and the last message; 0 for fewer than two."""
        span_ns = self.last_ns - self.first_ns
        return (self.count - 1) * 1e9 / span_ns if span_ns > 0 else 0.0

    def add(self, recorded: Recorded) -> None:
        """Count one message."""
        if self.count == 0:
            self.first_ns = self.last_ns = recorded.log_ns
        else:
            self.lost += max(0, recorded.sequence - self._sequence - 1) if recorded.sender else 0
            self.longest_gap_ns = max(self.longest_gap_ns, recorded.log_ns - self.last_ns)
        self.count += 1
        self.bytes += len(recorded.data)
        self.first_ns = min(self.first_ns, recorded.log_ns)  # other recorders keep no order
        self.last_ns, self._sequence = max(self.last_ns, recorded.log_ns), recorded.sequence


@dataclass(slots=True)
class Survey:
    """What a recording holds."""

    streams: dict[tuple[str, str, str], Stream] = field(default_factory=dict)
    modes: Counter[str] = field(default_factory=Counter)  # ticks spent in each of the executive's modes
    faults: list[str] = field(default_factory=list)  # reasons of FAULT, as they came up
    stops: list[str] = field(default_factory=list)  # reasons of drivers that stopped by themselves
    actions: list[ActionFinished] = field(default_factory=list)
    results: list[tuple[str, str]] = field(default_factory=list)  # (goal, result) of each episode
    late_ms: list[float] = field(default_factory=list)
    work_ms: list[float] = field(default_factory=list)
    skipped: int = 0  # whole periods lost
    _mode: dict[str, str] = field(default_factory=dict)
    _result: str = ""

    @property
    def span_ns(self) -> tuple[int, int]:
        """Log times of the first and the last message; (0, 0) if there is none."""
        streams = self.streams.values()
        return min((s.first_ns for s in streams), default=0), max((s.last_ns for s in streams), default=0)


def survey(recording: Recording) -> Survey:
    """Read everything once."""
    found = Survey()
    for recorded in recording.messages():
        place = (recorded.key, recorded.sender, recorded.ros_type)
        stream = found.streams.setdefault(place, Stream(recorded.key, recorded.ros_type, recorded.sender))
        stream.add(recorded)
        kind = type_of(recorded.ros_type)
        if kind is None:
            continue
        message = decode(kind, recorded.data)
        if isinstance(message, Rejected):
            stream.rejected[message.reason] += 1
        elif kind in _NOTES:
            _NOTES[kind](found, recorded.key, message)
    return found


def percentiles(values: list[float]) -> dict[str, float]:
    """p50, p99 and maximum; zeros for no values."""
    known = sorted(values) or [0.0]
    return {f"p{q}" if q < 100 else "max": round(_percentile(known, q), 3) for q in (50, 99, 100)}


def _percentile(known: list[float], q: int) -> float:
    """Between the two nearest of some sorted values, as numpy's; which loads numpy.ma for it, 40 ms."""
    place = (len(known) - 1) * q / 100
    low = int(place)
    return known[low] + (known[min(low + 1, len(known) - 1)] - known[low]) * (place - low)


def _status(found: Survey, key: str, message: ExecStatus) -> None:
    found.modes[message.mode] += 1
    if message.mode == "FAULT" and found._mode.get(key) != "FAULT":
        found.faults.append(reason_text(message.reason, message.detail))
    if message.result and message.result != found._result:
        result = result_text(message.result, message.result_reason, message.result_detail)
        found.results.append((message.goal, result))
    found._mode[key], found._result = message.mode, message.result


def _driver(found: Survey, key: str, message: DriverState) -> None:
    if message.mode in ("stopped", "estopped") and found._mode.get(key) != message.mode:
        found.stops.append(f"{key.partition('/')[0]}: {reason_text(message.reason, message.detail)}")
    found._mode[key] = message.mode


def _finished(found: Survey, _: str, message: ActionFinished) -> None:
    found.actions.append(message)


def _tick(found: Survey, _: str, message: TickReport) -> None:
    found.late_ms.append(message.lateness_ns / 1e6)
    found.work_ms.append(message.work_ns / 1e6)
    found.skipped += message.skipped


_NOTES: dict[type, Callable[[Survey, str, Any], None]] = {
    ExecStatus: _status,
    DriverState: _driver,
    ActionFinished: _finished,
    TickReport: _tick,
}
