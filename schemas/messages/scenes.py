"""What people see of a robot and its surroundings in 3D: shapes, and the frames in which they stand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tailor.schemas.messages.message import Message

ARROW, BOX, SPHERE, CYLINDER, LINE, TEXT = 0, 1, 2, 3, 4, 9  # kinds of shapes, as visualization_msgs/Marker has them


@dataclass(frozen=True, slots=True)
class Shape:
    """One shape; make it with the functions of tailor.schemas.packages.scene."""

    name: str  # unique in its message
    kind: int  # ARROW, BOX, SPHERE, CYLINDER, LINE or TEXT
    frame: str
    x: float  # m, in the frame
    y: float  # m
    z: float  # m
    qx: float  # unit quaternion
    qy: float
    qz: float
    qw: float
    length: float  # m, along its own x; width of a line
    width: float  # m, along its own y
    height: float  # m, along its own z; of a text's capitals
    red: float  # 0..1
    green: float
    blue: float
    alpha: float  # 1: opaque
    lifetime_s: float  # viewers drop the shape when it was not repeated for so long; 0: never
    text: str = ""
    points: tuple[float, ...] = ()  # of a line: x, y, z of each point in turn, m, relative to its pose


@dataclass(frozen=True, slots=True)
class SceneShapes(Message):
    """All shapes of one scene, at one time."""

    ROS_TYPE: ClassVar[str] = "visualization_msgs/msg/MarkerArray"

    stamp_ns: int
    shapes: tuple[Shape, ...] = ()


@dataclass(frozen=True, slots=True)
class FrameTransform:
    """Pose of a frame in its parent frame."""

    parent: str
    child: str
    x: float  # m
    y: float  # m
    z: float  # m
    qx: float  # unit quaternion
    qy: float
    qz: float
    qw: float


@dataclass(frozen=True, slots=True)
class FrameTransforms(Message):
    """Poses of frames at one time; each frame has one parent (REP-105)."""

    ROS_TYPE: ClassVar[str] = "tf2_msgs/msg/TFMessage"

    stamp_ns: int
    transforms: tuple[FrameTransform, ...] = ()


@dataclass(frozen=True, slots=True)
class LogLine(Message):
    """One line for people, of what a run does; viewers show them in a log."""

    ROS_TYPE: ClassVar[str] = "rcl_interfaces/msg/Log"

    stamp_ns: int
    level: int  # INFO, WARNING or ERROR
    name: str  # of who did it
    text: str


INFO, WARNING, ERROR = 20, 30, 40  # as rcl_interfaces/Log has them
