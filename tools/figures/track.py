"""Track of a run for figures and tables: path, speed, actions with predicted and actual durations."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from tailor.schemas.messages import ActionFinished, ExecStatus, Message, Subgoals, TickReport
from tailor.schemas.reason_text import result_text
from tailor.tools.viewer.planar_scene import TRUTH_TYPES, PlanarScene, Position, scene_of_message


@dataclass(frozen=True, slots=True)
class Point:
    """Ground truth every 0.1 s in metres, radians and m/s; `action` counts the actions since the start."""

    time_s: float
    x: float
    y: float
    phi: float
    v: float
    objects: dict[str, Position]
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
        """Sum of the durations predicted when each action started."""
        return sum(action.predicted_s for action in self.finished)


LATE_NS = 50_000_000  # half a period


def track_of(title: str, messages: Iterable[Message]) -> Track:
    """Collect a track from a run's messages in the order of their recording."""
    track = Track(title)
    status: ExecStatus | None = None
    for message in messages:
        if isinstance(message, ExecStatus):
            status = message
            track.result = result_text(message.result, message.result_reason, message.result_detail) or track.result
        elif isinstance(message, ActionFinished):
            track.finished.append(message)
        elif isinstance(message, Subgoals):
            track.subgoals.append(message)
        elif isinstance(message, TickReport):
            track.ticks += 1
            track.late_ticks += message.lateness_ns > LATE_NS
            track.missed_ticks += message.skipped
        elif isinstance(message, TRUTH_TYPES) and status is not None and status.action:
            scene = scene_of_message(message)
            if scene is not None:
                time_s = getattr(message, "stamp_ns", 0) / 1e9
                track.points.append(_point(time_s, scene, status))
    return track


def _point(time_s: float, scene: PlanarScene, status: ExecStatus) -> Point:
    index, name = status.action_index, status.action
    return Point(time_s, scene.x, scene.y, scene.phi, scene.v, scene.objects, index, name)
