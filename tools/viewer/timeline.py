"""Converts the messages of a run into the events that the page shows.

States are sent on change, samples at a limited rate.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tailor.schemas import messages as m
from tailor.schemas.installed import robot_names, spec_of_robot
from tailor.schemas.packages.pose3 import Pose3
from tailor.schemas.packages.scene import Scene
from tailor.schemas.reason_text import reason_text, result_text
from tailor.schemas.topics import STALE_S
from tailor.tools.scenes.driver_starts import DriverStarts
from tailor.tools.scenes.flat import Outline, flat, projected
from tailor.tools.scenes.robot_scenes import TRUTH_KEYS, RobotScenes, planar_pose
from tailor.tools.viewer import event_fields
from tailor.tools.viewer.event_fields import Fields
from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.plan_graph import plan_graph
from tailor.tools.viewer.run_facts import run_facts
from tailor.tools.viewer.silence import Silence

PAUSE_S = 2 * STALE_S  # of all messages at once; in a shorter one it may be the recorder that stood still
STATE_GAP_S = 0.06  # passes 10 Hz with jitter and thins out faster samples
# Other messages that have no event of their own become plain series of numbers.
NOT_SHOWN = (m.ArmRequest, m.PlanRequest, m.PlanAnswer, m.SceneShapes, m.FrameTransforms, m.LogLine)
REPORTS = (m.Subgoals, m.RefinementReport, m.PlanReport, m.ActionFinished)  # one with the last one's stamp is no news
SAMPLES = frozenset({"tick", "belief", "truth", "believed", "seen", "odom"})

Rows = list[tuple[str, Fields]]  # kind and fields of events


@dataclass(frozen=True, slots=True)
class Event:
    """One event of the page: seconds on its time axis, kind, and fields."""

    at_s: float
    kind: str
    fields: Fields

    def json_value(self) -> list[Any]:
        """The event as the page reads it: [at, kind, fields]."""
        return [round(self.at_s, 3), self.kind, self.fields]


def is_sample(kind: str) -> bool:
    """Whether events of a kind are numbers that arrive all the time, many a second."""
    return kind in SAMPLES or kind.startswith("series ")


class RunTimeline:
    """Converts messages, in order, into events.

    Args:
      explainer: Computes the alternatives of subgoals from the action models; None: they are not shown.
      robot: The only robot to show; empty: the one that the executive names, and any until then.

    Attributes:
      robot: The same, as known so far.
    """

    def __init__(self, explainer: Explainer | None = None, robot: str = "") -> None:
        self.robot = robot
        self._explainer = explainer
        self._scenes = RobotScenes()
        self._silence = Silence()
        self._received_s = 0.0  # time of the last message
        self._starts = DriverStarts()
        self._action_index = -1  # of the action in execution
        self._last: dict[str, Any] = {}  # by kind: last fields of states; by key: last reports
        self._outlines: dict[str, Outline] = {}  # by kind: the last ones
        self._sampled_s: dict[str, float] = {}  # by kind: time of the last sample

    @property
    def scene_fault(self) -> str:
        """What the scene of the robot's package raised last; nothing is drawn then."""
        return self._scenes.fault

    def events_of(self, at_s: float, key: str, message: m.Message) -> list[Event]:
        """Convert one message.

        Args:
          at_s: Time of its reception, seconds since the start of the run.
          key: Its zenoh key.
          message: Its value.
        """
        owner, _, topic = key.partition("/")
        if topic and self.robot and owner not in ("exec", self.robot):
            return []
        silences = self._silences_before(at_s)
        self._silence.note(message, at_s)
        silences += self.silences(at_s)
        if isinstance(message, REPORTS):
            if self._last.get(key) == message:
                return silences
            self._last[key] = message
        return silences + [Event(at_s, kind, fields) for kind, fields in self._rows(at_s, key, message)]

    def silences(self, at_s: float) -> list[Event]:
        """An event if executive or driver have fallen silent by now, or are heard again."""
        silent = self._silence.change(at_s)
        return [] if silent is None else [Event(at_s, "silent", silent)]

    def _silences_before(self, at_s: float) -> list[Event]:
        """An event if before this time no message at all came for long: then every part had fallen silent."""
        last_s, self._received_s = self._received_s, at_s
        return self.silences(last_s + STALE_S + 1e-3) if at_s - last_s > PAUSE_S else []

    def _rows(self, at_s: float, key: str, message: m.Message) -> Rows:
        match message:
            case m.Provenance():
                return self._provenance(message)
            case m.ExecStatus():
                return self._status(at_s, message)
            case m.Odometry() | m.PoseEstimate():
                source = "odom" if isinstance(message, m.Odometry) else "seen"
                return self._path(at_s, source, planar_pose(message)) if self._due(at_s, source) else []
            case m.TickReport():
                return [("tick", event_fields.tick(message))]
            case m.ActionFinished():
                return [("finished", event_fields.finished(message))]
            case m.Contexts():
                return self._objects(message)
            case m.Subgoals():
                return self._subgoals(message)
            case m.RefinementReport():
                return [("refinement", event_fields.refinement(message))]
            case m.PlanReport():
                return [("plan", plan_graph(message))]
            case m.DriverState():
                anew: Rows = [("restart", {})] if self._starts.is_another(message, key) else []
                return anew + self._changed("driver", event_fields.driver(message))
            case m.EStop():
                return self._stops(message)
        return self._other(at_s, key, message)

    def _other(self, at_s: float, key: str, message: m.Message) -> Rows:
        """Ground truth that can be drawn, else a series of numbers."""
        if isinstance(message, NOT_SHOWN):
            return []
        robot, _, topic = key.partition("/")
        if topic in TRUTH_KEYS and not self._scenes.robot and robot in robot_names():  # the executive is not up yet
            self._scenes = RobotScenes(spec_of_robot(robot).name)
        if topic in TRUTH_KEYS and (scene := self._scenes.of_truth(message)):
            return self._path(at_s, "truth", scene)
        kind = f"series {key.rpartition('/')[2]}"
        return self._sampled(at_s, kind, event_fields.numbers(message)) if self._due(at_s, kind) else []

    def _provenance(self, message: m.Provenance) -> Rows:
        if self._last.get("provenance") == message.json:
            return []
        self._last["provenance"] = message.json
        facts = run_facts(message.json)
        self._scenes = RobotScenes(facts.get("domain", ""))
        self.robot = self.robot or facts.get("robot", "")
        if self._explainer is not None:
            self._explainer.load(message.json)
        return [("about", facts)]

    def _status(self, at_s: float, message: m.ExecStatus) -> Rows:
        state: Fields = {
            "mode": message.mode,
            "reason": reason_text(message.reason, message.detail),
            "scenario": message.scenario,
            "goal": message.goal,
            "result": result_text(message.result, message.result_reason, message.result_detail),
        }
        rows = self._changed("state", state)
        self._action_index = message.action_index if message.action else -1
        rows += self._changed("action", {"index": self._action_index, "action": message.action})
        if self._due(at_s, "belief"):
            rows += self._sampled(at_s, "belief", event_fields.belief(message))
        return rows + self._path(at_s, "believed", self._scenes.of_belief(message.belief))

    def _path(self, at_s: float, source: str, scene: Scene | None) -> Rows:
        """Scene of a source, with the action in execution: outlines on change, places at a limited rate."""
        shown = flat(scene, self._scenes.seen_from) if scene is not None and self._due(at_s, source) else None
        if shown is None:
            return []
        rows = self._sampled(at_s, source, {**event_fields.scene(shown), "index": self._action_index})
        outlines = ((f"outline {source} {name}", each) for name, each in shown.outlines.items())
        return [row for kind, each in outlines for row in self._outline(kind, each)] + rows

    def _outline(self, kind: str, outline: Outline) -> Rows:
        if self._outlines.get(kind) is outline:
            return []
        self._outlines[kind] = outline
        return self._changed(kind, event_fields.outline(outline))

    def _objects(self, message: m.Contexts) -> Rows:
        """No row of their own: they belong to the subgoals that follow in the same tick, and to the coming scenes."""
        self._scenes.note(message)
        if self._explainer is not None:
            self._explainer.note(message)
        return []

    def _subgoals(self, message: m.Subgoals) -> Rows:
        goals = self._scenes.of_subgoals(message)
        places = {goal.label: self._place(goal.pose) for goal in goals}
        targets = {goal.label: self._place(goal.target) for goal in goals if goal.target is not None}
        rows: Rows = [("subgoals", {**event_fields.subgoals(message), "places": places, "targets": targets})]
        explanation = self._explainer.fields(message) if self._explainer is not None else None
        return rows + ([("why", explanation)] if explanation else [])

    def _place(self, pose: Pose3) -> list[float | None]:
        return event_fields.place(projected((pose.x, pose.y, pose.z), self._scenes.seen_from))

    def _stops(self, message: m.EStop) -> Rows:
        """Every stop, but of a dead man's switch, which is held ten times a second, only the first message."""
        if message.stop:
            self._last.pop("estop", None)
            return [("estop", {"stop": True})]
        return self._changed("estop", {"stop": False})

    def _changed(self, kind: str, fields: Fields) -> Rows:
        if self._last.get(kind) == fields:
            return []
        self._last[kind] = fields
        return [(kind, fields)]

    def _due(self, at_s: float, kind: str) -> bool:
        since_s = at_s - self._sampled_s.get(kind, -1.0)
        return since_s >= STATE_GAP_S or since_s < 0.0  # a recording of a clock that was set back goes on

    def _sampled(self, at_s: float, kind: str, fields: Fields) -> Rows:
        """A sample, which is due."""
        if not fields:
            return []
        self._sampled_s[kind] = at_s
        return [(kind, fields)]
