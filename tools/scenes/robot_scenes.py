"""The scenes of one robot, from the messages of its run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any

from tailor.executive import domains
from tailor.schemas import messages as m
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import part, spec_of
from tailor.schemas.messages.scenes import FrameTransform, Shape
from tailor.schemas.packages.pose3 import Pose3
from tailor.schemas.packages.scene import Scene
from tailor.schemas.packages.spec import DomainSpec
from tailor.schemas.parsed_files import shown
from tailor.schemas.topics import TOPICS
from tailor.tools.scenes import planar_convention

_TRUTH = [topic for topic in TOPICS.values() if topic.source == "simulator"]
TRUTH_KEYS = frozenset(topic.key.partition("/")[2] for topic in _TRUTH)  # without the robot
TRUTH_TYPES = tuple({topic.type for topic in _TRUTH})


@dataclass(frozen=True, slots=True)
class Subgoal:
    """Where an action is to end: pose in "map", whether its heading matters, whether a parameter of it is free.

    `target` is where the robot is to work from there, if anywhere, e.g. the spot of a cup.
    """

    label: str
    pose: Pose3
    headed: bool
    free: bool
    target: Pose3 | None = None


class RobotScenes:
    """Scenes of a robot, by its package's `scene` or by convention.

    Attributes:
      seen_from: "above" or "behind", see SceneView.
      robot: Name of the robot; empty without a domain.
      has_odometry: Whether odometry is one of its sensors, so that "odom" stands between "map" and "base_link".
      fault: What the package's `scene` raised last, or returned in place of a drawing; it draws nothing then.
    """

    def __init__(self, domain: str = "") -> None:
        """Load the scene that a domain declares; "" or a domain that is not installed: the convention alone."""
        self._view: Any = planar_convention
        self._names: tuple[str, ...] = ()
        self._quantities: dict[str, dict[str, str]] = {}
        self._truth: dict[type, Scene] = {}
        self._objects: tuple[Shape, ...] = ()
        self.robot = self.fault = ""
        self.has_odometry = False
        try:
            spec = spec_of(domain)
            loaded = domains.load(domain)
        except UsageError:
            spec = None
        if spec is not None:
            actions = loaded.actions.items()
            self._quantities = {name: {p.name: p.quantity for p in action.parameters} for name, action in actions}
            self.has_odometry = "odom" in loaded.sensors
            self.robot, self._names = spec.robot, tuple(_bare(name) for name in loaded.belief_names)
            self._view = self._declared(spec)
        self.seen_from: str = getattr(self._view, "VIEW", "above")

    def _declared(self, spec: DomainSpec) -> Any:
        """The package's view; the convention if it has none, or one that cannot be imported."""
        try:
            return part(spec, "scene") if spec.scene else planar_convention
        except UsageError as error:
            self.fault = str(error)
            return planar_convention

    def note(self, message: m.Contexts) -> None:
        """Draw the objects that actions take into account in the coming believed scenes, if the package draws them."""
        if hasattr(self._view, "of_object"):
            rows = [dict(zip(each.columns, row, strict=False)) for each in message.contexts for row in each.rows]
            self._objects = tuple(dict.fromkeys(filter(None, (self._called("of_object", row) for row in rows))))

    def of_belief(self, values: Sequence[float]) -> Scene | None:
        """The believed scene; None if there is none, as without `belief_values`."""
        scene = self._made("of_belief", dict(zip(self._names, values, strict=False))) if values else None
        return scene and replace(scene, shapes=(*scene.shapes, *self._objects))

    def of_truth(self, message: m.Message) -> Scene | None:
        """The true scene with this message and the newest ones of other types; None without a robot's pose in it."""
        scene = self._made("of_truth", message)
        if scene is None:
            return None
        self._truth[type(message)] = scene
        if not scene.frames:
            return None
        others = (each for kind, each in self._truth.items() if kind is not type(message))
        shapes = [*scene.shapes, *(shape for each in others for shape in each.shapes)]
        return Scene(scene.frames, tuple(shapes), scene.tracer, scene.speed_mps)

    def of_subgoals(self, message: m.Subgoals) -> tuple[Subgoal, ...]:
        """All subgoals that have a place: goals of the actions, not the start of the first."""
        values: dict[str, dict[str, float]] = {}
        everything: dict[str, dict[str, float]] = {}  # also of where an action starts: the arm works where it stands
        free: set[str] = set()
        for action in message.actions:
            start = action.parameters[0].label if action.parameters else ""
            for parameter in action.parameters:
                quantity = self._quantity(action.action, parameter.name)
                everything.setdefault(parameter.label, {}).setdefault(quantity, parameter.value)
                if parameter.label != start:
                    known = values.setdefault(parameter.label, {})
                    known.setdefault(quantity, parameter.value)
                    free |= set() if parameter.bound else {parameter.label}
        return tuple(
            Subgoal(label, pose, "phi" in known, label in free, self._target(everything[label]))
            for label, known in values.items()
            if (pose := self._called("of_subgoal", known)) is not None
        )

    def _target(self, known: dict[str, float]) -> Pose3 | None:
        target: Pose3 | None = self._called("of_target", known) if hasattr(self._view, "of_target") else None
        return target

    def _quantity(self, action: str, parameter: str) -> str:
        """Quantity of an action's parameter as its domain declares it."""
        return self._quantities.get(action, {}).get(parameter, parameter.removesuffix("g"))

    def _made(self, function: str, argument: Any) -> Scene | None:
        scene = self._called(function, argument)
        return scene if scene is not None and (scene.frames or scene.shapes) else None

    def _called(self, function: str, argument: Any) -> Any:
        """What the package returns; None if it fails, or is no drawing: no page or bus goes down with one."""
        try:
            drawn = getattr(self._view, function)(argument)
        except Exception as error:
            self.fault = f"{function}: {type(error).__name__}: {error}"
            return None
        expected = _expected_of(function, drawn)
        if not expected:
            return drawn
        self.fault = f"{function} returned {shown(drawn)}, expected {expected} (schemas/packages/scene.py)"
        return None


def _expected_of(function: str, drawn: Any) -> str:
    """What is expected in place of what a package's function returned; empty if that can be drawn."""
    if function not in ("of_belief", "of_truth"):
        kind: type = Shape if function == "of_object" else Pose3
        return "" if drawn is None or isinstance(drawn, kind) else f"a {kind.__name__} or None"
    if not isinstance(drawn, Scene):
        return "a Scene"
    parts = ((drawn.frames, FrameTransform), (drawn.shapes, Shape))
    whole = all(isinstance(row, tuple | list) and all(isinstance(each, kind) for each in row) for row, kind in parts)
    well = whole and isinstance(drawn.tracer, str) and isinstance(drawn.speed_mps, Real)
    return "" if well else "a Scene of frames and shapes, with a tracer's name and a speed"


def planar_pose(message: m.Message) -> Scene | None:
    """The scene of an odometry or a pose estimate, of whatever robot: its pose alone."""
    scene = planar_convention.of_truth(message)
    return Scene(scene.frames, (), scene.tracer, scene.speed_mps) if scene.frames else None


def _bare(name: str) -> str:
    """Name of a belief value without its unit: "ball x (m)" is ball_x."""
    return name.partition(" (")[0].replace(" ", "_")
