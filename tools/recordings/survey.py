"""Statistics of a recording in one pass: streams, gaps, modes, actions, results, tick timing. Prints nothing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from tailor.runtime.recordings.recording import Recorded, Recording
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ActionFinished, DriverState, ExecStatus, TickReport
from tailor.schemas.reason_text import reason_text, result_text


@dataclass(slots=True)
class Stream:
    """Messages of one key and sender."""

    key: str
    ros_type: str
    sender: str
    count: int = 0
    bytes: int = 0
    first_ns: int = 0
    last_ns: int = 0
    lost: int = 0  # sequence numbers missing between two received ones
    longest_gap_ns: int = 0
    rejected: Counter[str] = field(default_factory=Counter)
    _sequence: int = 0

    @property
    def rate_hz(self) -> float:
        """Mean rate between the first and the last message; 0 for fewer than two messages."""
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
        self.first_ns = min(self.first_ns, recorded.log_ns)  # other recorders do not sort
        self.last_ns, self._sequence = max(self.last_ns, recorded.log_ns), recorded.sequence


@dataclass(frozen=True, slots=True)
class _Result:
    """Result of a task, and the first tick that reported it."""

    goal: str
    result: str
    tick: int


@dataclass(slots=True)
class Survey:
    """Statistics of a recording."""

    streams: dict[tuple[str, str, str], Stream] = field(default_factory=dict)
    modes: Counter[str] = field(default_factory=Counter)  # ticks spent in each of the executive's modes
    faults: list[str] = field(default_factory=list)  # reasons of FAULT, in order
    stops: list[str] = field(default_factory=list)  # reasons of drivers that stopped by themselves
    actions: list[ActionFinished] = field(default_factory=list)
    results: list[tuple[str, str]] = field(default_factory=list)  # (goal, result) of each run
    late_ms: list[float] = field(default_factory=list)
    work_ms: list[float] = field(default_factory=list)
    skipped: int = 0  # whole periods lost
    _mode: dict[tuple[str, str], str] = field(default_factory=dict)  # last one, by key and sender
    _results: dict[str, _Result] = field(default_factory=dict)  # last one, by sender

    @property
    def span_ns(self) -> tuple[int, int]:
        """Log times of the first and the last message; (0, 0) if there is none."""
        streams = self.streams.values()
        return min((s.first_ns for s in streams), default=0), max((s.last_ns for s in streams), default=0)


def survey(recording: Recording) -> Survey:
    """Read all messages of a recording once."""
    counted = Survey()
    for recorded in recording.messages():
        identity = (recorded.key, recorded.sender, recorded.ros_type)
        stream = counted.streams.setdefault(identity, Stream(recorded.key, recorded.ros_type, recorded.sender))
        stream.add(recorded)
        message = recorded.value()
        if isinstance(message, Rejected):
            stream.rejected[message.reason] += 1
        elif count := _COUNTERS.get(type(message)):
            count(counted, recorded, message)
    return counted


def percentiles(values: list[float]) -> dict[str, float]:
    """p50, p99 and maximum; zeros for no values."""
    ordered = sorted(values) or [0.0]
    return {f"p{q}" if q < 100 else "max": round(_percentile(ordered, q), 3) for q in (50, 99, 100)}


def _percentile(ordered: list[float], q: int) -> float:
    """Linear interpolation as in numpy.percentile, which would load numpy.ma (40 ms)."""
    position = (len(ordered) - 1) * q / 100
    low = int(position)
    return ordered[low] + (ordered[min(low + 1, len(ordered) - 1)] - ordered[low]) * (position - low)


def _status(counted: Survey, recorded: Recorded, message: ExecStatus) -> None:
    key, sender = recorded.key, recorded.sender
    counted.modes[message.mode] += 1
    if message.mode == "FAULT" and counted._mode.get((key, sender)) != "FAULT":
        counted.faults.append(reason_text(message.reason, message.detail))
    counted._mode[key, sender] = message.mode
    last = counted._results.get(sender)
    if not message.result:
        counted._results.pop(sender, None)
    elif last is None or (last.goal, last.result) != (message.goal, message.result):
        result = result_text(message.result, message.result_reason, message.result_detail)
        counted.results.append((message.goal, result))
        counted._results[sender] = _Result(message.goal, message.result, message.tick)


def _driver(counted: Survey, recorded: Recorded, message: DriverState) -> None:
    key, sender = recorded.key, recorded.sender
    if message.mode in ("stopped", "estopped") and counted._mode.get((key, sender)) != message.mode:
        counted.stops.append(f"{key.partition('/')[0]}: {reason_text(message.reason, message.detail)}")
    counted._mode[key, sender] = message.mode


def _finished(counted: Survey, _: Recorded, message: ActionFinished) -> None:
    counted.actions.append(message)


def _tick(counted: Survey, recorded: Recorded, message: TickReport) -> None:
    last = counted._results.get(recorded.sender)
    if message.goal and last is not None and last.tick < message.tick:
        del counted._results[recorded.sender]  # another task begins, perhaps with the same goal and result
    counted.late_ms.append(message.lateness_ns / 1e6)
    counted.work_ms.append(message.work_ns / 1e6)
    counted.skipped += message.skipped


_COUNTERS: dict[type, Callable[[Survey, Recorded, Any], None]] = {
    ExecStatus: _status,
    DriverState: _driver,
    ActionFinished: _finished,
    TickReport: _tick,
}
