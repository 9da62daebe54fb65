"""What a robot says of itself and of what it sees."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Odometry:
    """nav_msgs/Odometry: dead-reckoned pose in odom frame (m, rad), velocity in base_link (m/s, rad/s)."""

    stamp_ns: int
    x: float
    y: float
    phi: float
    v: float
    omega: float


@dataclass(frozen=True, slots=True)
class PoseEstimate:
    """geometry_msgs/PoseWithCovarianceStamped: absolute pose in the map frame, variances in m² and rad²."""

    stamp_ns: int
    x: float
    y: float
    phi: float
    var_x: float
    var_y: float
    var_phi: float


@dataclass(frozen=True, slots=True)
class JointState:
    """sensor_msgs/JointState: rad, rad/s and N·m of each named joint; all tuples have one length."""

    stamp_ns: int
    names: tuple[str, ...] = ()
    positions: tuple[float, ...] = ()
    velocities: tuple[float, ...] = ()
    efforts: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class BallPercept:
    """The ball as the camera sees it: position in base_link (m), covariance (m²), x ahead, y left."""

    stamp_ns: int
    x: float
    y: float
    var_x: float
    var_y: float
    cov_xy: float


@dataclass(frozen=True, slots=True)
class MotorCurrents:
    """Motor currents in A since the last message of this kind: the one of now, and the largest magnitude."""

    stamp_ns: int
    names: tuple[str, ...] = ()
    amperes: tuple[float, ...] = ()
    peak_amperes: tuple[float, ...] = ()
