"""Commands, arming, the e-stop and the state of a driver."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class VelocityCommand(Message):
    """Velocity set-point in base_link; other components of the twist are written as zero."""

    ROS_TYPE: ClassVar[str] = "geometry_msgs/msg/TwistStamped"

    stamp_ns: int
    v: float  # linear.x, m/s
    omega: float  # angular.z, rad/s


@dataclass(frozen=True, slots=True)
class JointCommand(Message):
    """Velocity set-points of named joints; the driver closes the current loop (paper Table 5)."""

    stamp_ns: int
    names: tuple[str, ...] = ()
    velocities: tuple[float, ...] = ()  # rad/s


@dataclass(frozen=True, slots=True)
class EStop(Message):
    """True stops and latches every driver; only an ArmRequest with `reset` releases it.

    False means that its sender holds a dead man's switch and repeats this message: after 0.5 s of silence every driver
    stops and latches.
    """

    ROS_TYPE: ClassVar[str] = "std_msgs/msg/Bool"

    stop: bool


@dataclass(frozen=True, slots=True)
class ArmRequest(Message):
    """Request to arm or disarm a driver for one sender of commands."""

    arm: bool
    reset: bool  # also release a latched e-stop
    sender: str  # 32 hex digits; empty: the sender of this message
    epoch: int  # epoch of the driver that is meant; 0: any


@dataclass(frozen=True, slots=True)
class DriverState(Message):
    """State of a driver and of its guard."""

    stamp_ns: int
    mode: str  # disarmed, armed, stopped, estopped
    reason: str  # for the mode; values: simnodes/guard.py
    detail: str  # free text about the reason
    epoch: int  # changes with every start of the driver
    armed_sender: str  # 32 hex digits, empty unless armed
    accepted: int  # commands since start
    refused_reasons: tuple[str, ...] = ()  # parallel to refused_counts
    refused_counts: tuple[int, ...] = ()
    command_stamp_ns: int = 0  # of the newest command that passed since arming, by its sender's clock; 0: none
