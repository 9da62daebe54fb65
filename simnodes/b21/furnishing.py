"""Builds the kitchen of kitchen.toml in PyBullet: floor, walls, furniture. Only tables and stool are ever moved."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from tailor.schemas.kitchen.furniture import Place, kitchen, on_table
from tailor.schemas.messages.kitchen import KitchenObject
from tailor.schemas.packages.pose3 import Vector
from tailor.simnodes.b21.engine import pybullet
from tailor.simnodes.b21.physical_parameters import PhysicalParameters

Colour = tuple[float, float, float, float]
Shape = tuple[Vector, Vector]  # centre and size of a box
FLOOR: Colour = (0.80, 0.77, 0.70, 1.0)
WALL: Colour = (0.90, 0.90, 0.87, 1.0)
WOOD: Colour = (0.66, 0.48, 0.30, 1.0)
COLOURS: dict[str, Colour] = {
    "counter": (0.55, 0.60, 0.62, 1.0),
    "fridge": (0.92, 0.93, 0.95, 1.0),
    "cupboard": (0.50, 0.36, 0.24, 1.0),
    "stool": (0.25, 0.42, 0.55, 1.0),
}
MOVABLE = (*kitchen().tables, "stool")


class Furnishing:
    """The furniture of one world.

    Attributes:
      names: Name of each piece by its body in PyBullet; the floor is none.
      places: Place of each piece that may be displaced, map frame.
    """

    def __init__(self, client: int, parameters: PhysicalParameters) -> None:
        """Build everything at its nominal place."""
        self._bullet, self._client, self._parameters = pybullet(), client, parameters
        self.places: dict[str, Place] = {}
        self.names: dict[int, str] = {}
        self._build_room()
        for name, box in kitchen().fixed.items():
            self._add(name, box.place, [_standing(box.size)], COLOURS[name])
        for name, place in kitchen().tables.items():
            self._add(name, place, _table_shapes(), WOOD)
        self._add_stool()
        self._bodies = {name: body for body, name in self.names.items()}

    def place(self, name: str, place: Place) -> None:
        """Move a table or the stool."""
        self.places[name] = place
        self._bullet.resetBasePositionAndOrientation(
            self._bodies[name], (place[0], place[1], 0.0), _upright(place[2]), physicsClientId=self._client
        )

    def objects(self) -> tuple[KitchenObject, ...]:
        """Tables and stool where they stand."""
        heights = {**dict.fromkeys(kitchen().tables, kitchen().table.size[2]), "stool": kitchen().stool.height}
        return tuple(KitchenObject(name, x, y, heights[name], phi, 0.0) for name, (x, y, phi) in self.places.items())

    def height_at(self, x: float, y: float) -> float:
        """Height of what carries a cup at a place: a table, other furniture, or the floor."""
        size = kitchen().table.size
        tables = [(self.places[name], size) for name in kitchen().tables]
        boxes = [(box.place, box.size) for box in kitchen().fixed.values()]
        return max((size[2] for place, size in (*tables, *boxes) if _covers(place, size, x, y)), default=0.0)

    def _build_room(self) -> None:
        (west, east), (south, north) = kitchen().x, kitchen().y
        thick, high = kitchen().wall_thickness, kitchen().wall_height
        middle, width, depth = ((west + east) / 2, (south + north) / 2), east - west, north - south
        floor = self._body([((*middle, -0.05), (width + 2 * thick, depth + 2 * thick, 0.1))], FLOOR)
        self._change(floor, self._parameters.floor_friction)
        walls: tuple[tuple[str, Vector, Vector], ...] = (
            ("west wall", (west - thick / 2, middle[1], high / 2), (thick, depth, high)),
            ("east wall", (east + thick / 2, middle[1], high / 2), (thick, depth, high)),
            ("south wall", (middle[0], south - thick / 2, high / 2), (width + 2 * thick, thick, high)),
            ("north wall", (middle[0], north + thick / 2, high / 2), (width + 2 * thick, thick, high)),
        )
        for name, centre, size in walls:
            self.names[self._body([(centre, size)], WALL)] = name

    def _add(self, name: str, place: Place, shapes: Sequence[Shape], colour: Colour) -> None:
        body = self._body(shapes, colour, place)
        self._change(body, self._parameters.table_friction)
        self.names[body] = name
        if name in MOVABLE:
            self.places[name] = place

    def _add_stool(self) -> None:
        stool, bullet = kitchen().stool, self._bullet
        where = {"physicsClientId": self._client}
        middle = (0.0, 0.0, stool.height / 2)
        solid = bullet.createCollisionShape(
            bullet.GEOM_CYLINDER, radius=stool.radius, height=stool.height, collisionFramePosition=middle, **where
        )
        seen = bullet.createVisualShape(
            bullet.GEOM_CYLINDER,
            radius=stool.radius,
            length=stool.height,
            visualFramePosition=middle,
            rgbaColor=COLOURS["stool"],
            **where,
        )
        self.names[bullet.createMultiBody(0, solid, seen, (*stool.place, 0.0), **where)] = "stool"
        self.places["stool"] = (*stool.place, 0.0)

    def _body(self, shapes: Sequence[Shape], colour: Colour, place: Place = (0.0, 0.0, 0.0)) -> int:
        """A body that never moves by itself, of boxes relative to its place."""
        bullet, count = self._bullet, len(shapes)
        kinds, centres = [bullet.GEOM_BOX] * count, [centre for centre, _ in shapes]
        halves = [[side / 2 for side in size] for _, size in shapes]
        where: dict[str, Any] = {"physicsClientId": self._client}
        solid = bullet.createCollisionShapeArray(kinds, halfExtents=halves, collisionFramePositions=centres, **where)
        seen = bullet.createVisualShapeArray(kinds, halfExtents=halves, visualFramePositions=centres, **where)
        body: int = bullet.createMultiBody(0, solid, seen, (place[0], place[1], 0.0), _upright(place[2]), **where)
        bullet.changeVisualShape(body, -1, rgbaColor=colour, **where)
        return body

    def _change(self, body: int, friction: float) -> None:
        self._bullet.changeDynamics(
            body,
            -1,
            lateralFriction=friction,
            restitution=self._parameters.bounce,
            physicsClientId=self._client,
        )


def _table_shapes() -> list[Shape]:
    """Top, legs and cutlery of a table, relative to its place."""
    table = kitchen().table
    (depth, width, high), thick, leg = table.size, table.top_thickness, table.leg
    shapes: list[Shape] = [((0.0, 0.0, high - thick / 2), (depth, width, thick))]
    for x in (-(depth - leg) / 2, (depth - leg) / 2):
        for y in (-(width - leg) / 2, (width - leg) / 2):
            shapes.append(((x, y, (high - thick) / 2), (leg, leg, high - thick)))
    return shapes + [((x, y, high + tall / 2), (long, wide, tall)) for x, y, long, wide, tall in table.cutlery]


def _standing(size: Vector) -> Shape:
    return (0.0, 0.0, size[2] / 2), size


def _covers(place: Place, size: Vector, x: float, y: float) -> bool:
    back = on_table((0.0, 0.0, -place[2]), x - place[0], y - place[1])
    return abs(back[0]) <= size[0] / 2 and abs(back[1]) <= size[1] / 2


def _upright(phi: float) -> tuple[float, float, float, float]:
    return 0.0, 0.0, math.sin(phi / 2), math.cos(phi / 2)
