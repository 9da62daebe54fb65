"""State of a whole system at one moment, as plain data; its fields are those of `tailor status --json`."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages import ProcessState


@dataclass(frozen=True, slots=True)
class Spread:
    """Distribution of a duration, ms."""

    p50: float
    p99: float
    max: float


@dataclass(frozen=True, slots=True)
class TickTimes:
    """Timing of an executive's ticks of the last minute."""

    reported: int
    skipped: int  # whole periods lost
    work_ms: Spread
    lateness_ms: Spread  # start of the tick after its deadline


@dataclass(frozen=True, slots=True)
class ExecutiveView:
    """One executive: its newest status and the timing of its ticks."""

    sender: str
    age_s: float  # of the status
    silent: bool
    mode: str
    reason: str
    detail: str
    scenario: str
    goal: str
    result: str
    result_reason: str
    result_detail: str
    action: str
    action_elapsed_s: float
    action_predicted_s: float
    ticks: TickTimes | None
    realtime: dict[str, str]  # privileges granted by the operating system; empty until published
    required: dict[str, float]  # nominal rates (Hz) of what its domain requires, by key; empty until published


@dataclass(frozen=True, slots=True)
class DriverView:
    """One driver and its guard."""

    robot: str
    age_s: float
    silent: bool
    mode: str
    reason: str
    detail: str
    epoch: int
    restarts: int  # seen by this observer
    armed_sender: str
    armed_for: str  # "executive": one that is on the bus; "absent": none that is; "": not armed
    accepted: int
    refused: dict[str, int]  # by reason


@dataclass(frozen=True, slots=True)
class LauncherView:
    """The processes that `tailor up` supervises, as it published them last."""

    age_s: float
    silent: bool
    processes: tuple[ProcessState, ...]


@dataclass(frozen=True, slots=True)
class TopicView:
    """One topic under one key."""

    key: str
    received: int
    age_s: float
    published: str  # "periodically" or "on change", which includes on demand
    rate_hz: float | None  # measured over at most 5 s; None: fewer than two messages, or not periodical
    nominal_hz: float  # 0: not periodical
    stale_after_s: float | None
    stale: bool
    slow: bool  # below 3/4 of its rate; only topics with a stale limit
    senders: int  # of the last second


@dataclass(frozen=True, slots=True)
class ForeignView:
    """Publications that are no message of ours."""

    unknown: dict[str, int]  # by key; keys beyond the first 50 count as "other keys"
    refused: dict[str, dict[str, int]]  # by key of ours and reason
    dropped: int  # unread by this observer, which could not keep up


@dataclass(frozen=True, slots=True)
class Finding:
    """One problem: a value of `Problem`, and free text about it."""

    problem: str
    detail: str


@dataclass(frozen=True, slots=True)
class Picture:
    """Everything that an observer knows."""

    healthy: bool
    problems: tuple[Finding, ...]
    observed_s: float
    executives: tuple[ExecutiveView, ...]  # newest first
    restarts: int  # executives that replaced a silent one while observed
    drivers: tuple[DriverView, ...]
    launcher: LauncherView | None  # None: not launched by `tailor up`
    topics: tuple[TopicView, ...]
    foreign: ForeignView
