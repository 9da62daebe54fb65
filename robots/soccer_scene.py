"""What AGILO, balls, opponents and field look like. Metres, radians."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from tailor.schemas.messages import Message
from tailor.schemas.messages.scenes import FrameTransform, Shape
from tailor.schemas.messages.soccer import BallTruth, OpponentsTruth, SoccerGroundTruth
from tailor.schemas.packages.pose3 import Pose3, on_plane
from tailor.schemas.packages.scene import BASE, BLUE, DARK, Scene, box, cylinder, frame, line, sphere

BALL_M = 0.11
FIELD_M = (3.5, 2.25)  # half its length and width
YELLOW = (0.9, 0.75, 0.1, 1.0)
FAR_M = 20.0  # a ball so far away is none of the scenario
OPPONENT_HEIGHT_M = 0.6
AXLE_M = 0.0625  # height of the axle
MOST_OPPONENTS = 4
RAIL_M = ((0.288, 0.119), (0.255, 0.106), (0.227, 0.083), (0.207, 0.053), (0.196, 0.018))  # left half, from its tip


def of_belief(values: Mapping[str, float]) -> Scene:
    """Believed pose, balls once seen, opponents once seen."""
    shapes = [*ROBOT, *FIELD]
    if values.get("ball_sigma", -1.0) >= 0.0:
        shapes += _ball(values["ball_x"], values["ball_y"])
    if values.get("ball2_sigma", -1.0) >= 0.0:
        shapes.append(_second_ball(values["ball2_x"], values["ball2_y"]))
    for number in range(1, MOST_OPPONENTS + 1):
        if values.get(f"opponent{number}_sigma", -1.0) >= 0.0:
            x, y, radius_m = (values[f"opponent{number}_{quantity}"] for quantity in ("x", "y", "radius"))
            shapes.append(_opponent(number, x, y, radius_m))
    return Scene((_base(values["x"], values["y"], values["phi"]),), tuple(shapes), BASE, values["v"])


def of_truth(message: Message) -> Scene:
    """True pose and ball, or true second ball, or true opponents."""
    if isinstance(message, SoccerGroundTruth):
        shapes = (*ROBOT, *FIELD, *_ball(message.ball_x, message.ball_y))
        return Scene((_base(message.x, message.y, message.phi),), shapes, BASE, message.v)
    if isinstance(message, BallTruth):
        return Scene(shapes=(_second_ball(message.x, message.y),))
    if isinstance(message, OpponentsTruth):
        standing = enumerate(message.opponents, 1)
        return Scene(shapes=tuple(_opponent(number, each.x, each.y, each.radius_m) for number, each in standing))
    return Scene()


def of_subgoal(values: Mapping[str, float]) -> Pose3 | None:
    """A place on the field, with a heading if it has one."""
    return on_plane(values["x"], values["y"], values.get("phi", 0.0)) if {"x", "y"} <= values.keys() else None


def _base(x: float, y: float, phi: float) -> FrameTransform:
    return frame(BASE, on_plane(x, y, phi))


def _ball(x: float, y: float) -> Iterator[Shape]:
    if math.hypot(x, y) < FAR_M:
        yield sphere("ball", BALL_M, on_plane(x, y, z=BALL_M))


def _second_ball(x: float, y: float) -> Shape:
    return sphere("second ball", BALL_M, on_plane(x, y, z=BALL_M), YELLOW)


def _opponent(number: int, x: float, y: float, radius_m: float) -> Shape:
    place = on_plane(x, y, z=OPPONENT_HEIGHT_M / 2)
    return cylinder(f"opponent {number}", radius_m, OPPONENT_HEIGHT_M, place, BLUE, "map")


def _rail() -> Shape:
    half = [(ahead, left, 0.11) for ahead, left in RAIL_M]
    return line("rail", [*half, *((ahead, -left, z) for ahead, left, z in reversed(half))], 0.012, DARK, BASE)


def _field() -> Shape:
    x, y = FIELD_M
    corners = ((-x, -y), (x, -y), (x, y), (-x, y), (-x, -y))
    return line("field", [(left, up, 0.0) for left, up in corners], 0.03, (0.75, 0.78, 0.75, 1.0))


ROBOT = (
    box("chassis", (0.41, 0.32, 0.16), on_plane(-0.025, 0.0, z=AXLE_M + 0.08)),
    cylinder("left wheel", AXLE_M, 0.04, Pose3(0.0, 0.15, AXLE_M, math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)), DARK),
    cylinder("right wheel", AXLE_M, 0.04, Pose3(0.0, -0.15, AXLE_M, math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)), DARK),
    line("ahead", [(0.0, 0.0, 0.225), (0.18, 0.0, 0.225)], 0.02, DARK, BASE),
    _rail(),
)
FIELD = (_field(),)
