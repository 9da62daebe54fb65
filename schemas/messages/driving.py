"""What moves and stops a robot: commands, arming, the e-stop, and what its driver answers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class VelocityCommand:
    """geometry_msgs/TwistStamped: linear.x in m/s, angular.z in rad/s, base_link frame."""

    stamp_ns: int
    v: float
    omega: float


@dataclass(frozen=True, slots=True)
class JointCommand:
    """Velocity set-points of named joints, rad/s; the driver closes the current loop (paper Table 5)."""

    stamp_ns: int
    names: tuple[str, ...] = ()
    velocities: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class EStop:
    """std_msgs/Bool: true stops and latches every driver; it takes an ArmRequest with `reset` to leave."""

    stop: bool


@dataclass(frozen=True, slots=True)
class ArmRequest:
    """Arm or disarm a driver for one sender; `reset` also leaves a latched e-stop."""

    arm: bool
    reset: bool
    sender: str  # 32 hex digits; empty: the sender of this message
    epoch: int  # the driver's epoch that is meant; 0: whichever


@dataclass(frozen=True, slots=True)
class DriverState:
    """What a driver says of itself: mode (disarmed, armed, stopped, estopped), why, whom it obeys."""

    stamp_ns: int
    mode: str
    reason: str
    epoch: int  # changes with every start of the driver
    armed_sender: str  # 32 hex digits, empty while disarmed
    accepted: int  # commands since start
    refused_reasons: tuple[str, ...] = ()
    refused_counts: tuple[int, ...] = ()
