"""Measurements of a robot's own state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class Odometry(Message):
    """Dead-reckoned pose in the odom frame, velocity in base_link."""

    ROS_TYPE: ClassVar[str] = "nav_msgs/msg/Odometry"

    stamp_ns: int
    x: float  # m
    y: float  # m
    phi: float  # rad
    v: float  # m/s
    omega: float  # rad/s


@dataclass(frozen=True, slots=True)
class PoseEstimate(Message):
    """Absolute pose in the map frame with variances."""

    ROS_TYPE: ClassVar[str] = "geometry_msgs/msg/PoseWithCovarianceStamped"

    stamp_ns: int
    x: float  # m
    y: float  # m
    phi: float  # rad
    var_x: float  # m²
    var_y: float  # m²
    var_phi: float  # rad²


@dataclass(frozen=True, slots=True)
class PlanarTruth(Message):
    """Exact state of a simulated robot on the plane; no belief reads it."""

    FRAME_ID: ClassVar[str] = "map"

    stamp_ns: int
    x: float  # m
    y: float  # m
    phi: float  # rad
    v: float  # m/s
    omega: float  # rad/s


@dataclass(frozen=True, slots=True)
class JointState(Message):
    """State of named joints; all tuples have one length."""

    ROS_TYPE: ClassVar[str] = "sensor_msgs/msg/JointState"

    stamp_ns: int
    names: tuple[str, ...] = ()
    positions: tuple[float, ...] = ()  # rad
    velocities: tuple[float, ...] = ()  # rad/s
    efforts: tuple[float, ...] = ()  # N·m


@dataclass(frozen=True, slots=True)
class MotorCurrents(Message):
    """Motor currents since the previous message of this type."""

    stamp_ns: int
    names: tuple[str, ...] = ()
    amperes: tuple[float, ...] = ()  # present value
    peak_amperes: tuple[float, ...] = ()  # largest magnitude
