"""Reads kitchen.toml: the sizes and nominal places of the kitchen. Metres, radians, frame map."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

Place = tuple[float, float, float]  # x, y, phi
Size = tuple[float, float, float]  # along phi, across, height


@dataclass(frozen=True, slots=True)
class Box:
    """Furniture that never moves."""

    place: Place
    size: Size


@dataclass(frozen=True, slots=True)
class Table:
    """What all tables share.

    Attributes:
      slots: Where cups stand, in the table's frame.
      cutlery: Boxes that are fixed to the top: x, y in the table's frame, and size.
      displaced: Largest displacement of a drawn episode, in x, y and phi.
    """

    size: Size
    top_thickness: float
    leg: float
    slots: tuple[tuple[float, float], ...]
    cutlery: tuple[tuple[float, float, float, float, float], ...]
    displaced: Place


@dataclass(frozen=True, slots=True)
class Stool:
    """A cylinder on the floor, in the way."""

    place: tuple[float, float]
    radius: float
    height: float
    displaced: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Cup:
    """What all cups share; phi of a cup is the direction from its axis to its handle."""

    radius: float
    height: float
    mass_kg: float
    handle: Size
    grasp_height: float  # above the bottom
    displaced: Place  # in the table's frame
    tipped_rad: float  # a cup that leans more has tipped


@dataclass(frozen=True, slots=True)
class Kitchen:
    """All of it.

    Attributes:
      x, y: Range of the room.
      start, start_displaced: The robot's.
      tables: Nominal places by name.
      cups: Nominal table, number of the slot there, and direction of the handle in the table's frame, by name.
    """

    x: tuple[float, float]
    y: tuple[float, float]
    wall_height: float
    wall_thickness: float
    start: Place
    start_displaced: Place
    fixed: Mapping[str, Box]
    table: Table
    tables: Mapping[str, Place]
    stool: Stool
    cup: Cup
    cups: Mapping[str, tuple[str, int, float]]

    @property
    def edge_m(self) -> float:
        """Distance from the middle of a table to the edge where the robot stands."""
        return self.table.size[0] / 2


@cache
def kitchen() -> Kitchen:
    """The kitchen that ships."""
    text = resources.files(__package__).joinpath("kitchen.toml").read_text(encoding="utf-8")
    read = _frozen(tomllib.loads(text))
    room, start = read["room"], read["start"]
    return Kitchen(
        **room,
        start=start["place"],
        start_displaced=start["displaced"],
        fixed={name: Box(**each) for name, each in read["fixed"].items()},
        table=Table(**read["table"]),
        tables=read["tables"],
        stool=Stool(**read["stool"]),
        cup=Cup(**read["cup"]),
        cups=read["cups"],
    )


def on_table(table: Place, x: float, y: float, phi: float = 0.0) -> Place:
    """A place in the table's frame, in the frame of the table's place."""
    c, s = math.cos(table[2]), math.sin(table[2])
    return table[0] + c * x - s * y, table[1] + s * x + c * y, math.remainder(table[2] + phi, math.tau)


def _frozen(value: Any) -> Any:
    """Lists as tuples, all the way down."""
    if isinstance(value, list):
        return tuple(_frozen(each) for each in value)
    return {name: _frozen(each) for name, each in value.items()} if isinstance(value, dict) else value
