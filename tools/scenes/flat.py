"""Scenes projected onto a plane, for pages and pictures: the robot's place, and the outline of each shape."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from operator import attrgetter
from typing import NamedTuple

from tailor.schemas.messages.scenes import ARROW, BOX, CYLINDER, LINE, SPHERE, TEXT, Shape
from tailor.schemas.packages.pose3 import Pose3, Vector
from tailor.schemas.packages.scene import MAP, Scene, frames_below, on_map, pose_of

Point = tuple[float, float]

RING = 24  # corners of a circle
DIGITS = 9  # of metres and of quaternions


class Looks(NamedTuple):
    """A shape without its name and pose."""

    kind: int
    frame: str
    length: float
    width: float
    height: float
    red: float
    green: float
    blue: float
    alpha: float
    text: str
    points: tuple[float, ...]


_looks_of = attrgetter(*Looks._fields)


@dataclass(frozen=True, slots=True)
class Outline:
    """Outline of a shape in its own plane, m; a text has its words and a point.

    `on_robot`: it is drawn relative to the robot's place. `robots`: a part of the robot, not an object.
    """

    points: tuple[Point, ...]
    closed: bool
    colour: tuple[float, float, float, float]
    width_m: float = 0.0  # of a line
    words: str = ""
    on_robot: bool = False
    robots: bool = False


@dataclass(frozen=True, slots=True)
class FlatScene:
    """A scene on a plane: place (m) and heading (rad, None where it has none) of the tracer, its speed, all shapes.

    `places` are place and heading of each shape that is not rigidly on the robot.
    """

    x: float
    y: float
    phi: float | None
    speed_mps: float
    places: Mapping[str, tuple[float, float, float]]
    outlines: Mapping[str, Outline]


def flat(scene: Scene, seen_from: str) -> FlatScene | None:
    """Project a scene; None if its tracer has no pose."""
    frames = on_map(scene.frames)
    tracer = frames.get(scene.tracer)
    if tracer is None:
        return None
    above = seen_from != "behind"
    places: dict[str, tuple[float, float, float]] = {}
    outlines: dict[str, Outline] = {}
    carried = frames_below(scene.frames, scene.tracer) if above else {}
    for shape in scene.shapes:
        if shape.frame in carried:
            outlines[shape.name] = _carried(shape, carried[shape.frame], seen_from)
        elif shape.frame in frames:
            world = pose_of(shape) if shape.frame == MAP else frames[shape.frame].then(pose_of(shape))
            x, y = projected((world.x, world.y, world.z), seen_from)
            yaw, turn = _orientation((world.qx, world.qy, world.qz, world.qw), above)
            places[shape.name] = (x, y, yaw)
            outlines[shape.name] = _outline(Looks(*_looks_of(shape)), turn, seen_from)
    x, y = projected((tracer.x, tracer.y, tracer.z), seen_from)
    return FlatScene(x, y, tracer.yaw if above else None, scene.speed_mps, places, outlines)


def projected(point: Vector, seen_from: str) -> Point:
    """A point of the map on the plane: x and y from above, right and up from behind."""
    return (-point[1], point[2]) if seen_from == "behind" else (point[0], point[1])


def _rounded(pose: Pose3) -> Pose3:
    """Without the noise of rounding, by which a shape at rest would differ from sample to sample."""
    values = (pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw)
    return Pose3(*(round(value, DIGITS) for value in values))


# An hour's samples have the same few shapes, and things turn less often than they move: what does not depend on a
# place is kept.
@lru_cache(maxsize=1024)
def _carried(shape: Shape, frame: Pose3, seen_from: str) -> Outline:
    """Outline of a part of the robot; `frame` is relative to the robot."""
    return _outline(Looks(*_looks_of(shape)), _rounded(frame.then(pose_of(shape))), seen_from, on_robot=True)


@lru_cache(maxsize=1024)
def _orientation(quaternion: tuple[float, float, float, float], above: bool) -> tuple[float, Pose3]:
    """Heading on the plane, rad, and the rest of the turn."""
    whole = Pose3(0.0, 0.0, 0.0, *quaternion)
    yaw = whole.yaw if above else 0.0
    back = Pose3(0.0, 0.0, 0.0, 0.0, 0.0, -math.sin(yaw / 2), math.cos(yaw / 2))
    return yaw, _rounded(back.then(whole))


@lru_cache(maxsize=1024)
def _outline(shape: Looks, pose: Pose3, seen_from: str, on_robot: bool = False) -> Outline:
    points = [projected(pose.moved(point), seen_from) for point in _corners(shape)]
    if shape.kind == SPHERE:  # round from every side
        (x, y), radius = projected((pose.x, pose.y, pose.z), seen_from), shape.length / 2
        points = [(x + radius * c, y + radius * s) for c, s in _circle()]
    closed = shape.kind in (BOX, SPHERE, CYLINDER)
    colour = (shape.red, shape.green, shape.blue, shape.alpha)
    width_m = shape.length if shape.kind == LINE else shape.width if shape.kind == ARROW else shape.height
    return Outline(
        tuple(_hull(points) if closed else points),
        closed,
        colour,
        0.0 if closed else width_m,
        shape.text,
        on_robot,
        shape.frame != MAP,
    )


def _corners(shape: Looks) -> list[Vector]:
    """Points of a shape, relative to its pose, whose projections bound it; in order along a line or an arrow."""
    x, y, z = shape.length / 2, shape.width / 2, shape.height / 2
    if shape.kind == BOX:
        return [(i * x, j * y, k * z) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    if shape.kind == CYLINDER:
        return [(x * c, y * s, k * z) for c, s in _circle() for k in (-1, 1)]
    if shape.kind == LINE:
        numbers = shape.points
        return [(numbers[i], numbers[i + 1], numbers[i + 2]) for i in range(0, len(numbers) - 2, 3)]
    if shape.kind == ARROW:
        tip, back = shape.length, shape.length - 1.5 * shape.width
        return [(0.0, 0.0, 0.0), (tip, 0.0, 0.0), (back, shape.width, 0.0), (tip, 0.0, 0.0), (back, -shape.width, 0.0)]
    return [(0.0, 0.0, 0.0)] if shape.kind == TEXT else []


def _circle() -> list[Point]:
    return [(math.cos(math.tau * k / RING), math.sin(math.tau * k / RING)) for k in range(RING)]


def _hull(points: Iterable[Point]) -> list[Point]:
    """Convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted({(round(x, 6), round(y, 6)) for x, y in points})
    if len(ordered) < 3:
        return ordered
    halves = []
    for row in (ordered, ordered[::-1]):
        half: list[Point] = []
        for point in row:
            while len(half) > 1 and _turn(half[-2], half[-1], point) <= 0.0:
                half.pop()
            half.append(point)
        halves.append(half[:-1])
    return [*halves[0], *halves[1]]


def _turn(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
