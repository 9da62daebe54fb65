"""Analytic stand-ins for learned action models, and a small domain around them, for tests of refinement."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tailor.executive.interfaces.action import Action, Control, Parameter
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.ranges import Ranges
from tailor.executive.refinement.objective.sequence import ActionSequence, InstantiatedAction, Variable

PI = float(np.pi)


def within(ranges: Ranges, candidates: Array) -> bool:
    return bool(np.all((candidates >= ranges.lower) & (candidates <= ranges.upper)))


def norm(angle: Array) -> Array:
    return np.mod(angle + PI, 2 * PI) - PI


@dataclass
class PoseDuration:
    """Seconds to go from a pose to another: turning, driving, and turning again at the goal."""

    turn_weight: float = 1.0
    rows: int = 0

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        x, y, phi, v, xg, yg, phig, vg = arguments.T
        self.rows += len(arguments)
        distance = np.hypot(xg - x, yg - y)
        bearing = np.arctan2(yg - y, xg - x)
        to, at = np.abs(norm(bearing - phi)), np.abs(norm(phig - bearing))
        seconds = 0.5 + distance / 0.6 + to / 1.4 + self.turn_weight * at**1.5 / 1.2
        seconds += 0.8 * np.exp(-distance) * at + 0.6 * vg * at - 0.9 * v * np.cos(to) - 0.5 * vg * np.cos(at)
        return seconds, 0.1 + 0.05 * (to + at)


@dataclass
class ConeSuccess:
    """An approach succeeds from inside a cone behind the goal, and never from nearer than 0.3 m."""

    half_angle: float = 1.0
    nearest: float = 0.3

    def probability(self, arguments: Array) -> Array:
        x, y, _, _, xg, yg, phig, _ = arguments.T
        off = np.abs(norm(phig - np.arctan2(yg - y, xg - x)))
        near = np.hypot(xg - x, yg - y) - self.nearest
        return 1 / (1 + np.exp(-np.minimum(12 * (self.half_angle - off), 20 * near)))


@dataclass
class NeverSucceeds:
    def probability(self, arguments: Array) -> Array:
        return np.zeros(len(arguments))


@dataclass
class NotANumber:
    """A duration model that predicts NaN for goals in the right half."""

    inner: PoseDuration = field(default_factory=PoseDuration)

    def predict(self, arguments: Array) -> tuple[Array, Array]:
        mean, std = self.inner.predict(arguments)
        return np.where(arguments[:, 6] > 0, np.nan, mean), std


def idle(state: object, now_ns: int, belief: object, arguments: Array) -> Control:
    return Control(state, (0.0, 0.0), "done")


def pose_parameters() -> tuple[Parameter, ...]:
    parameters = []
    for argument, suffix in enumerate(("", "g")):
        parameters += [
            Parameter(f"x{suffix}", argument, "x", "m", -3.5, 3.5),
            Parameter(f"y{suffix}", argument, "y", "m", -2.25, 2.25),
            Parameter(f"phi{suffix}", argument, "phi", "rad", -PI, PI, periodic=True),
            Parameter(f"v{suffix}", argument, "v", "m/s", 0.0, 0.75),
        ]
    return tuple(parameters)


GO = Action("goToPose", pose_parameters(), idle, "goToPose/duration")
DRIBBLE = Action("dribbleBall", pose_parameters(), idle, "dribbleBall/duration")
APPROACH = Action("approachBall", pose_parameters(), idle, "goToPose/duration", "goToPose/success", "goToPose")
LIBRARY = {action.name: action for action in (GO, DRIBBLE, APPROACH)}
MODELS = Models(
    {"goToPose/duration": PoseDuration(), "dribbleBall/duration": PoseDuration(2.0)},
    {"goToPose/success": ConeSuccess()},
)


def sequence(actions: list[Action], places: list[dict[str, float | tuple[float, float]]]) -> ActionSequence:
    """Actions from place to place; a place gives values or (lower, upper) ranges; missing quantities are free."""
    variables: list[Variable] = []
    ids: list[dict[str, int]] = []
    for place_index, place in enumerate(places):
        ids.append({})
        for parameter in pose_parameters()[:4]:
            given = place.get(parameter.quantity, (parameter.lower, parameter.upper))
            lower, upper = given if isinstance(given, tuple) else (given, given)
            value = lower if lower == upper else None
            periodic = parameter.periodic and upper - lower >= 2 * PI
            ids[-1][parameter.quantity] = len(variables)
            variables.append(
                Variable(
                    len(variables),
                    f"pos{place_index}",
                    parameter.quantity,
                    parameter.unit,
                    lower,
                    upper,
                    periodic,
                    value,
                )
            )
    instances = tuple(
        InstantiatedAction(action, step + 1, (*ids[step].values(), *ids[step + 1].values()))
        for step, action in enumerate(actions)
    )
    return ActionSequence(instances, tuple(variables), LIBRARY)


def approach_dribble(robot: tuple[float, float, float] = (-1.0, 0.0, 0.0)) -> ActionSequence:
    """The paper's running example: the angle and the speed at the ball are free."""
    x, y, phi = robot
    start = {"x": x, "y": y, "phi": phi, "v": 0.0}
    ball = {"x": 1.0, "y": 0.0, "v": (0.0, 0.3)}
    target = {"x": 0.0, "y": 1.5, "phi": 2.6, "v": 0.0}
    return sequence([APPROACH, DRIBBLE], [start, ball, target])


def waypoints(count: int, rng: np.random.Generator) -> ActionSequence:
    """`count` legs of goToPose with free heading and speed at each waypoint, two free parameters a leg but the last."""
    places: list[dict[str, float | tuple[float, float]]] = [{"x": -3.0, "y": 0.0, "phi": 0.0, "v": 0.0}]
    places += [{"x": rng.uniform(-3, 3), "y": rng.uniform(-2, 2)} for _ in range(count - 1)]
    places.append({"x": rng.uniform(-3, 3), "y": rng.uniform(-2, 2), "phi": 0.5, "v": 0.0})
    return sequence([GO] * count, places)
