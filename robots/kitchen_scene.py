"""What the B21, its kitchen and the cups look like. Metres, radians; sizes are those of schemas/kitchen."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from tailor.schemas.kitchen.furniture import Place, kitchen
from tailor.schemas.kitchen.kinematics import (
    ARM,
    BASE_HEIGHT_M,
    BASE_RADIUS_M,
    CAMERA,
    FINGER_M,
    FOREARM_M,
    HAND_M,
    HOME,
    JOINTS,
    SHOULDER,
    TOOL_M,
    UPPER_ARM_M,
)
from tailor.schemas.messages import Message
from tailor.schemas.messages.kitchen import KitchenObject, KitchenTruth
from tailor.schemas.messages.scenes import FrameTransform, Shape
from tailor.schemas.packages.pose3 import Pose3, on_plane, turned
from tailor.schemas.packages.scene import BASE, BLUE, DARK, GREY, MAP, Colour, Scene, box, cylinder, frame, line

WOOD, STEEL, WHITE = (0.66, 0.48, 0.30, 1.0), (0.55, 0.60, 0.62, 1.0), (0.92, 0.93, 0.95, 1.0)
STOOL: Colour = (0.36, 0.42, 0.46, 1.0)  # no cup is of this colour
RED, YELLOW = (0.85, 0.25, 0.20, 1.0), (0.95, 0.75, 0.20, 1.0)
FURNITURE: dict[str, Colour] = {"counter": STEEL, "fridge": WHITE, "cupboard": (0.50, 0.36, 0.24, 1.0)}
CUPS: dict[str, Colour] = dict(zip(kitchen().cups, (RED, BLUE, YELLOW), strict=True))


def of_belief(values: Mapping[str, float]) -> Scene:
    """Believed pose, arm and gripper; tables, and cups where their places are believed."""
    angles = [values.get(joint, home) for joint, home in zip(JOINTS, HOME, strict=True)]
    shapes = [*_robot(values.get("width", 0.0)), *ROOM]
    for name in kitchen().tables:
        if f"{name}_x" in values:
            shapes.append(_table(name, (values[f"{name}_x"], values[f"{name}_y"], values[f"{name}_phi"])))
    for name in kitchen().cups:
        if f"{name}_x" in values:
            shapes.append(_cup(name, Pose3(*(values[f"{name}_{axis}"] for axis in "xyz"))))
    return Scene(_frames((values["x"], values["y"], values["phi"]), angles), tuple(shapes), BASE, values["v"])


def of_truth(message: Message) -> Scene:
    """The true pose, arm, furniture and cups."""
    if not isinstance(message, KitchenTruth):
        return Scene()
    things = (shape for each in message.objects for shape in _object(each))
    frames = _frames((message.x, message.y, message.phi), message.angles or HOME)
    return Scene(frames, (*_robot(message.width), *ROOM, *things), BASE, message.v)


def of_subgoal(values: Mapping[str, float]) -> Pose3 | None:
    """Where the robot stands; the spot of a cup where that is not known."""
    stand = on_plane(values["x"], values["y"], values.get("phi", 0.0)) if {"x", "y"} <= values.keys() else None
    return stand or of_target(values)


def of_target(values: Mapping[str, float]) -> Pose3 | None:
    """The spot of a cup on a table."""
    known = {"spot_x", "spot_y"} <= values.keys()
    return Pose3(values["spot_x"], values["spot_y"], kitchen().table.size[2]) if known else None


def of_object(values: Mapping[str, float]) -> Shape | None:
    """The stool as a drive takes it into account: where it was seen, or on the map. Boxes are drawn already."""
    return None if values["box_long"] > 0.0 else _stool("stool", values["box_x"], values["box_y"])


def _frames(pose: Place, angles: Sequence[float]) -> tuple[FrameTransform, ...]:
    """The chain from map to the grasp point; each frame is the parent of the next."""
    chain, parent, place = [frame(BASE, on_plane(*pose))], BASE, SHOULDER
    for joint, angle in zip(ARM, angles, strict=True):
        at = place if parent == BASE else (joint.ahead_m, 0.0, 0.0)
        chain.append(frame(joint.name, turned(joint.axis, angle, at), parent))
        parent = joint.name
    return (*chain, frame("tool", Pose3(TOOL_M), parent))


def _robot(width_m: float) -> Iterator[Shape]:
    yield from ROBOT
    long, thick, high = FINGER_M
    for side, sign in (("left", 1.0), ("right", -1.0)):
        place = Pose3(0.03 - long / 2, sign * (width_m + thick) / 2)
        yield box(f"{side} finger", (long, thick, high), place, DARK, "tool")


def _object(each: KitchenObject) -> Iterator[Shape]:
    if each.name in kitchen().tables:
        yield _table(each.name, (each.x, each.y, each.phi))
    elif each.name in kitchen().cups:
        lying = turned((0.0, 1.0, 0.0), each.tilt)
        yield _cup(each.name, on_plane(each.x, each.y, each.phi, each.z).then(lying))
    else:
        yield _stool(each.name, each.x, each.y)


def _table(name: str, place: Place) -> Shape:
    depth, width, height = kitchen().table.size
    return box(name, (depth, width, 0.03), on_plane(*place, z=height - 0.015), WOOD, MAP)


def _stool(name: str, x: float, y: float) -> Shape:
    height = kitchen().stool.height
    return cylinder(name, kitchen().stool.radius, height, Pose3(x, y, height / 2), STOOL, MAP)


def _cup(name: str, pose: Pose3) -> Shape:
    return cylinder(name, kitchen().cup.radius, kitchen().cup.height, pose, CUPS[name], MAP)


def _room() -> Iterator[Shape]:
    (west, east), (south, north) = kitchen().x, kitchen().y
    corners = ((west, south), (east, south), (east, north), (west, north), (west, south))
    yield line("walls", [(x, y, 0.0) for x, y in corners], 0.06, DARK)
    for name, each in kitchen().fixed.items():
        yield box(name, each.size, on_plane(*each.place, z=each.size[2] / 2), FURNITURE[name], MAP)


def _reach() -> Shape:
    """How far a level hand gets at the height of a cup on a table, from its left to its right."""
    ahead, left, shoulder = SHOULDER
    at = kitchen().table.size[2] + kitchen().cup.grasp_height
    far = HAND_M + math.sqrt((UPPER_ARM_M + FOREARM_M) ** 2 - (shoulder - at) ** 2)
    turns = [math.radians(5 * k) for k in range(-18, 19)]
    return line("reach", [(ahead + far * math.cos(a), left + far * math.sin(a), at) for a in turns], 0.01, GREY, BASE)


ROOM = tuple(_room())
ROBOT = (
    cylinder("enclosure", BASE_RADIUS_M, BASE_HEIGHT_M, Pose3(z=BASE_HEIGHT_M / 2)),
    line("ahead", [(0.0, 0.0, BASE_HEIGHT_M + 0.01), (BASE_RADIUS_M, 0.0, BASE_HEIGHT_M + 0.01)], 0.03, DARK, BASE),
    box("camera", (0.1, 0.24, 0.07), Pose3(*CAMERA), DARK),
    box("upper arm", (UPPER_ARM_M, 0.07, 0.07), Pose3(UPPER_ARM_M / 2), GREY, "lift"),
    box("forearm link", (FOREARM_M, 0.06, 0.06), Pose3(FOREARM_M / 2), GREY, "elbow"),
    _reach(),
    box("palm", (HAND_M - TOOL_M, 0.15, 0.04), Pose3(0.03), DARK, "hand"),
)
