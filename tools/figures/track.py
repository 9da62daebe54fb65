"""A run reduced to what is drawn and tabulated of it: path, speed, actions with predicted and actual durations."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from tailor.schemas.messages import ActionFinished, ExecStatus, Message, Subgoals, TickReport
from tailor.schemas.messages.soccer import SoccerGroundTruth


@dataclass(frozen=True, slots=True)
class Point:
    """Where the robot was, every 0.1 s: metres, radians, m/s; `action` counts the actions since the start."""

    time_s: float
    x: float
    y: float
    phi: float
    v: float
    ball_x: float
    ball_y: float
    action: int
    name: str


@dataclass(slots=True)
class Track:
    """One run. `ticks`, `late_ticks` (over 50 ms late) and `missed_ticks` are 0 for a run in lock-step."""

    title: str
    points: list[Point] = field(default_factory=list)
    finished: list[ActionFinished] = field(default_factory=list)
    subgoals: list[Subgoals] = field(default_factory=list)
    result: str = ""
    ticks: int = 0
    late_ticks: int = 0
    missed_ticks: int = 0

    @property
    def actual_s(self) -> float:
        """Sum of the actions' durations."""
        return sum(action.actual_s for action in self.finished)

    @property
    def predicted_s(self) -> float:
        """Sum of what was predicted for each action when it started."""
        return sum(action.predicted_s for action in self.finished)


LATE_NS = 50_000_000  # half a period


def track_of(title: str, messages: Iterable[Message]) -> Track:
    """Collect a track from a run's messages in the order of their recording."""
    track = Track(title)
    status: ExecStatus | None = None
    for message in messages:
        if isinstance(message, ExecStatus):
            status = message
            track.result = message.result or track.result
        elif isinstance(message, ActionFinished):
            track.finished.append(message)
        elif isinstance(message, Subgoals):
            track.subgoals.append(message)
        elif isinstance(message, TickReport):
            track.ticks += 1
            track.late_ticks += message.lateness_ns > LATE_NS
            track.missed_ticks += message.skipped
        elif isinstance(message, SoccerGroundTruth) and status is not None and status.action:
            track.points.append(_point(message, status))
    return track


def _point(truth: SoccerGroundTruth, status: ExecStatus) -> Point:
    return Point(
        time_s=truth.stamp_ns / 1e9,
        x=truth.x,
        y=truth.y,
        phi=truth.phi,
        v=truth.v,
        ball_x=truth.ball_x,
        ball_y=truth.ball_y,
        action=status.action_index,
        name=status.action,
    )
