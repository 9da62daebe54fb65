"""Reads a scene on the plane from named numbers: the robot's pose and the positions of objects.

The names follow a convention. `x`, `y`, `phi` and `v` are the robot's; each pair `NAME_x`, `NAME_y` is the position of
an object. A negative `NAME_sigma` marks an object that was never observed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, cast

from tailor.schemas.messages import Message
from tailor.schemas.topics import TOPICS

FAR_M = 20.0  # an object this far away is not part of the scenario
_TRUTH = [topic for topic in TOPICS.values() if topic.source == "simulator"]
TRUTH_KEYS = frozenset(topic.key.partition("/")[2] for topic in _TRUTH)  # without the robot
TRUTH_TYPES = tuple({topic.type for topic in _TRUTH})

Position = tuple[float, float]


@dataclass(frozen=True, slots=True)
class PlanarScene:
    """Pose of a robot in metres and radians, its speed in m/s, positions of objects by name in metres."""

    x: float
    y: float
    phi: float
    v: float
    objects: dict[str, Position]


def planar_scene(values: Mapping[str, float]) -> PlanarScene | None:
    """The scene that named numbers describe; None for a robot without a pose on the plane."""
    if not {"x", "y", "phi"} <= values.keys():
        return None
    names = [name.removesuffix("_x") for name in values if name.endswith("_x")]
    objects = {
        name: (values[f"{name}_x"], values[f"{name}_y"])
        for name in names
        if f"{name}_y" in values and values.get(f"{name}_sigma", 0.0) >= 0
    }
    near = {name: position for name, position in objects.items() if math.hypot(*position) < FAR_M}
    return PlanarScene(values["x"], values["y"], values["phi"], values.get("v", 0.0), near)


def scene_of_belief(names: tuple[str, ...], values: tuple[float, ...]) -> PlanarScene | None:
    """The scene of a belief, whose names are like "ball x (m)"."""
    bare = (name.partition(" (")[0].replace(" ", "_") for name in names)
    return planar_scene(dict(zip(bare, values, strict=False)))


def scene_of_message(message: Message) -> PlanarScene | None:
    """The scene of a ground truth, an odometry or a pose estimate; None for other messages."""
    values = {field.name: getattr(message, field.name) for field in fields(cast(Any, message))}
    return planar_scene({name: value for name, value in values.items() if isinstance(value, int | float)})
