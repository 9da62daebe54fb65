"""A run as the rows that the page is told: each thing once, when it changes, and states not too often."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tailor.schemas import messages as m
from tailor.schemas.messages.soccer import BallPercept, SoccerGroundTruth
from tailor.tools.viewer import event_fields
from tailor.tools.viewer.event_fields import Fields
from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.plan_graph import plan_graph
from tailor.tools.viewer.run_facts import about

STATE_GAP_S = 0.06  # lets 10 Hz through whatever its jitter, and thins out what comes more often
# Messages that everything is known of; what is not among them goes out as plain series of numbers.
SILENT = (m.ArmRequest, BallPercept, m.PlanRequest, m.PlanAnswer)


@dataclass(frozen=True, slots=True)
class Event:
    """One thing that the page is told: when (seconds on its time axis), what kind of thing, and its fields."""

    at_s: float
    kind: str
    fields: Fields

    def json_value(self) -> list[Any]:
        """As the page takes it: [at, kind, fields]."""
        return [round(self.at_s, 3), self.kind, self.fields]


class RunTimeline:
    """Turns messages, in order, into rows.

    Args:
      explainer: Computes the alternatives of subgoals from the action models; None: they are not shown.
      robot: The only robot to tell of; empty: the one that the executive names, and any until it does.
    """

    def __init__(self, explainer: Explainer | None = None, robot: str = "") -> None:
        self._robot = robot
        self._explainer = explainer
        self._names: tuple[str, ...] = ()
        self._action = (-1, "")
        self._last: dict[str, Any] = {}  # by kind: what was told last, of things told on change
        self._told_s: dict[str, float] = {}  # by kind: when, of things told at a rate

    def tell(self, at_s: float, key: str, message: m.Message) -> list[Event]:
        """The rows that follow from one message."""
        owner, _, rest = key.partition("/")
        if rest and self._robot and owner not in ("exec", self._robot):
            return []
        return [Event(at_s, kind, fields) for kind, fields in self._rows(at_s, key, message)]

    def _rows(self, at_s: float, key: str, message: m.Message) -> list[tuple[str, Fields]]:
        match message:
            case m.Provenance():
                return self._provenance(message)
            case m.ExecStatus():
                return self._status(at_s, message)
            case SoccerGroundTruth():
                return self._path(at_s, "truth", event_fields.truth(message))
            case m.Odometry():
                return self._path(at_s, "odom", event_fields.odometry(message))
            case m.PoseEstimate():
                return self._path(at_s, "seen", event_fields.seen(message))
            case m.TickReport():
                return [("tick", event_fields.tick(message))]
            case m.ActionFinished():
                return [("finished", event_fields.finished(message))]
            case m.Subgoals():
                return self._subgoals(message)
            case m.RefinementReport():
                return [("refinement", event_fields.refinement(message))]
            case m.PlanReport():
                return [("plan", plan_graph(message))]
            case m.DriverState():
                return self._changed("driver", event_fields.driver(message))
            case m.EStop():
                return [("estop", {"stop": message.stop})]
        if isinstance(message, SILENT):
            return []
        topic = key.rpartition("/")[2]
        return self._paced(at_s, f"series {topic}", event_fields.numbers(message))

    def _provenance(self, message: m.Provenance) -> list[tuple[str, Fields]]:
        if self._last.get("provenance") == message.json:
            return []
        self._last["provenance"] = message.json
        facts = about(message.json)
        self._names = tuple(facts.get("beliefNames", ()))
        self._robot = self._robot or facts.get("robot", "")
        if self._explainer is not None:
            self._explainer.learn(message.json)
        return [("about", facts)]

    def _status(self, at_s: float, message: m.ExecStatus) -> list[tuple[str, Fields]]:
        state = {name: getattr(message, name) for name in ("mode", "reason", "scenario", "goal", "result")}
        told = self._changed("state", state)
        action = (message.action_index if message.action else -1, message.action)
        self._action = action
        if self._last.get("action") != action:
            self._last["action"] = action
            told.append(("action", {"index": action[0], "action": action[1]}))
        belief = {
            "elapsed": event_fields.number(message.action_elapsed_s),
            "predicted": event_fields.number(message.action_predicted_s),
            "values": [event_fields.number(value) for value in message.belief],
        }
        told += self._paced(at_s, "belief", belief)
        robot = event_fields.believed(self._names, message.belief)
        return told + (self._path(at_s, "believed", robot) if robot else [])

    def _path(self, at_s: float, source: str, robot: Fields) -> list[tuple[str, Fields]]:
        """Where the robot was, and in which action."""
        return self._paced(at_s, source, {**robot, "index": self._action[0]})

    def _subgoals(self, message: m.Subgoals) -> list[tuple[str, Fields]]:
        told = [("subgoals", event_fields.subgoals(message))]
        explained = self._explainer.fields(message) if self._explainer is not None else None
        return told + ([("why", explained)] if explained else [])

    def _changed(self, kind: str, fields: Fields) -> list[tuple[str, Fields]]:
        if self._last.get(kind) == fields:
            return []
        self._last[kind] = fields
        return [(kind, fields)]

    def _paced(self, at_s: float, kind: str, fields: Fields) -> list[tuple[str, Fields]]:
        if not fields or at_s - self._told_s.get(kind, -1.0) < STATE_GAP_S:
            return []
        self._told_s[kind] = at_s
        return [(kind, fields)]
