"""Messages of the kitchen robot alone: its gripper, what it sees, and the ground truth of its simulator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class GripperCommand(Message):
    """Set-point of a gripper's width, which it keeps when its robot stops."""

    stamp_ns: int
    width: float  # m, between the fingers


@dataclass(frozen=True, slots=True)
class GripperState(Message):
    """A gripper as its own sensors measure it."""

    stamp_ns: int
    width: float  # m, between the fingers
    force: float  # N, with which the fingers press on what is between them


@dataclass(frozen=True, slots=True)
class ObjectPercept:
    """One object in the field of view, in base_link; the detector knows its name."""

    name: str  # e.g. "cup1", "table2", "stool"
    x: float  # m, of a cup's middle, of a table's or stool's middle
    y: float  # m
    z: float  # m, height of a cup's middle, of a table's or stool's top
    phi: float  # rad, direction of a cup's handle, of a table's front
    tilt: float  # rad, between the object's own axis and the vertical
    var_xy: float  # m^2, of x and y each
    var_z: float  # m^2
    var_phi: float  # rad^2


@dataclass(frozen=True, slots=True)
class ObjectPercepts(Message):
    """All objects that the camera found in one picture; none is a measurement, too."""

    FRAME_ID: ClassVar[str] = "base_link"

    stamp_ns: int
    objects: tuple[ObjectPercept, ...] = ()


@dataclass(frozen=True, slots=True)
class KitchenObject:
    """True pose of an object in the map frame; reference points as in ObjectPercept."""

    name: str
    x: float  # m
    y: float  # m
    z: float  # m
    phi: float  # rad
    tilt: float  # rad


@dataclass(frozen=True, slots=True)
class KitchenTruth(Message):
    """True state of the robot and its kitchen, map frame; the executive never reads it."""

    FRAME_ID: ClassVar[str] = "map"

    stamp_ns: int
    x: float  # m
    y: float  # m
    phi: float  # rad
    v: float  # m/s
    omega: float  # rad/s
    width: float  # m, between the fingers
    held: str  # name of the cup in the gripper, or empty
    angles: tuple[float, ...] = ()  # rad, of the arm, from the shoulder outward
    touched: tuple[str, ...] = ()  # furniture that base or arm have touched since the last message
    objects: tuple[KitchenObject, ...] = ()
