"""Scenes of robots whose package declares none: a robot on the plane, by the names of its numbers.

`x`, `y`, `phi` and `v` are the robot's; each pair `NAME_x`, `NAME_y` is the position of an object. A negative
`NAME_sigma` marks an object that was never observed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any, cast

from tailor.schemas.messages import Message
from tailor.schemas.packages.pose3 import Pose3, on_plane
from tailor.schemas.packages.scene import BASE, DARK, Scene, box, frame, line, sphere

FAR_M = 20.0  # an object this far away is not part of the scenario
OBJECT_M = 0.1  # radius
ROBOT = (
    box("robot", (0.4, 0.3, 0.2), on_plane(0.0, 0.0, z=0.1)),
    line("ahead", [(0.0, 0.0, 0.2), (0.2, 0.0, 0.2)], 0.02, DARK, BASE),
)


def of_belief(values: Mapping[str, float]) -> Scene:
    """The scene that named numbers describe; an empty one for a robot without a pose on the plane."""
    if not {"x", "y", "phi"} <= values.keys():
        return Scene()
    names = [name.removesuffix("_x") for name in values if name.endswith("_x")]
    near = {
        name: (values[f"{name}_x"], values[f"{name}_y"])
        for name in names
        if f"{name}_y" in values and values.get(f"{name}_sigma", 0.0) >= 0
    }
    objects = [
        sphere(name, OBJECT_M, on_plane(x, y, z=OBJECT_M)) for name, (x, y) in near.items() if math.hypot(x, y) < FAR_M
    ]
    base = frame(BASE, on_plane(values["x"], values["y"], values["phi"]))
    return Scene((base,), (*ROBOT, *objects), BASE, values.get("v", 0.0))


def of_truth(message: Message) -> Scene:
    """The scene of any message with a pose on the plane: a ground truth, an odometry, a pose estimate."""
    values = {field.name: getattr(message, field.name) for field in fields(cast(Any, message))}
    return of_belief({name: value for name, value in values.items() if isinstance(value, int | float)})


def of_subgoal(values: Mapping[str, float]) -> Pose3 | None:
    """A place on the plane, with a heading if it has one."""
    return on_plane(values["x"], values["y"], values.get("phi", 0.0)) if {"x", "y"} <= values.keys() else None
