"""Track of a run for figures and tables: path, speed, actions with predicted and actual durations."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from tailor.schemas.messages import ActionFinished, DriverState, ExecStatus, Message, Subgoals, TickReport
from tailor.schemas.packages.scene import Scene
from tailor.schemas.reason_text import result_text
from tailor.tools.cli.plain_text import plain
from tailor.tools.scenes.driver_starts import DriverStarts
from tailor.tools.scenes.flat import Outline, Point, flat, projected
from tailor.tools.scenes.robot_scenes import TRUTH_TYPES, RobotScenes, Subgoal


@dataclass(frozen=True, slots=True)
class TrackPoint:
    """Scene every 0.1 s in metres, radians and m/s; `action` counts the actions since the start.

    `phi` is None for a robot without a heading; `objects` are place and heading of things beside the robot. `restart`
    counts the restarts of the driver: where it changes, a simulator has put the robot elsewhere.
    """

    time_s: float
    x: float
    y: float
    phi: float | None
    v: float
    objects: dict[str, tuple[float, float, float]]
    action: int
    name: str
    restart: int = 0


@dataclass(frozen=True, slots=True)
class Goal:
    """A subgoal as last chosen for its action, projected; `phi` is None where it has no heading."""

    place: Point
    phi: float | None
    free: bool


@dataclass(slots=True)
class Track:
    """One run. `ticks`, `late_ticks` (over 50 ms late) and `missed_ticks` are 0 for a run in lock-step."""

    title: str
    points: list[TrackPoint] = field(default_factory=list)  # of the ground truth; without one of the belief
    outlines: dict[str, Outline] = field(default_factory=dict)  # of the objects
    body: dict[str, Outline] = field(default_factory=dict)  # of the robot's parts, where they move as one
    goals: list[Goal] = field(default_factory=list)
    finished: list[ActionFinished] = field(default_factory=list)
    result: str = ""
    ticks: int = 0
    late_ticks: int = 0
    missed_ticks: int = 0
    restarts: int = 0  # of the driver
    scene_fault: str = ""  # what the scene of the robot's package raised

    @property
    def actual_s(self) -> float:
        """Sum of the actions' durations."""
        return sum(action.actual_s for action in self.finished)

    @property
    def predicted_s(self) -> float:
        """Sum of the durations predicted when each action started."""
        return sum(action.predicted_s for action in self.finished)


LATE_NS = 50_000_000  # half a period
READ = (ExecStatus, ActionFinished, DriverState, Subgoals, TickReport, *TRUTH_TYPES)  # types that a track is made of


def track_of(title: str, messages: Iterable[Message], domain: str = "") -> Track:
    """Collect a track from a run's messages in the order of their recording.

    Args:
      title: Of the track.
      messages: Messages of the run.
      domain: Domain of the run, whose package draws it; empty: a robot on the plane, by convention.
    """
    track, scenes, starts = Track(title), RobotScenes(domain), DriverStarts()
    believed: list[TrackPoint] = []
    status: ExecStatus | None = None
    executed: dict[tuple[int, bool, str], Subgoals] = {}  # the first action of every sequence, in its last version
    for message in messages:
        if isinstance(message, ExecStatus):
            status = message
            result = result_text(message.result, message.result_reason, message.result_detail)
            track.result = plain(result) or track.result
            believed += _points(track, scenes, scenes.of_belief(message.belief), status, message.stamp_ns)
        elif isinstance(message, ActionFinished):
            track.finished.append(message)
        elif isinstance(message, Subgoals) and message.actions:
            first = message.actions[0]
            executed[(first.step, first.asserted, first.action)] = replace(message, actions=(first,))
        elif isinstance(message, TickReport):
            track.ticks += 1
            track.late_ticks += message.lateness_ns > LATE_NS
            track.missed_ticks += message.skipped
        elif isinstance(message, DriverState):
            track.restarts += starts.is_another(message)
        elif isinstance(message, TRUTH_TYPES) and status is not None:
            stamp_ns = getattr(message, "stamp_ns", 0)
            track.points += _points(track, scenes, scenes.of_truth(message), status, stamp_ns)
    track.points = track.points or believed
    track.scene_fault = scenes.fault
    seen = {name for point in track.points for name in point.objects}
    track.outlines = {name: outline for name, outline in track.outlines.items() if name in seen}
    track.goals = [_goal(goal, scenes) for each in executed.values() for goal in scenes.of_subgoals(each)]
    return track


def _points(
    track: Track, scenes: RobotScenes, scene: Scene | None, status: ExecStatus, stamp_ns: int
) -> Iterable[TrackPoint]:
    """The point of a scene while an action runs, or none."""
    shown = flat(scene, scenes.seen_from) if scene is not None and status.action else None
    if shown is None:
        return
    objects = {name: place for name, place in shown.places.items() if _is_object(shown.outlines[name])}
    track.outlines |= {name: shown.outlines[name] for name in objects}
    track.body |= {name: outline for name, outline in shown.outlines.items() if outline.on_robot and outline.closed}
    action = plain(status.action)  # matplotlib warns of a character that it cannot draw, and prints it as it is
    pose = shown.x, shown.y, shown.phi
    yield TrackPoint(
        stamp_ns / 1e9, *pose, shown.speed_mps, objects, status.action_index, action, restart=track.restarts
    )


def _is_object(outline: Outline) -> bool:
    return outline.closed and not outline.robots


def _goal(goal: Subgoal, scenes: RobotScenes) -> Goal:
    pose = goal.pose
    phi = pose.yaw if goal.headed and scenes.seen_from == "above" else None
    return Goal(projected((pose.x, pose.y, pose.z), scenes.seen_from), phi, goal.free)
