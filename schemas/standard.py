"""Converts our planar messages to standard ROS 2 messages and back (REP-103 axes, REP-105 frames).

A planar robot has x, y and yaw. All other fields of a standard message are written as zero; when read, they must be
finite and are otherwise ignored.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np

from tailor.schemas import messages as m
from tailor.schemas.errors import DecodeRefusal, RefusedValueError
from tailor.schemas.numbers import check_array, check_numbers, check_variances
from tailor.schemas.ros_time import header, stamp_ns, time, time_ns
from tailor.schemas.typesystem import ros_class

UNIT_TOLERANCE = 1e-3  # of a quaternion's squared norm; drivers that send float32 stay far below
COVARIANCE_X, COVARIANCE_Y, COVARIANCE_YAW = 0, 7, 35  # on the diagonal of ROS's 6x6 matrix


@cache
def _geometry(name: str) -> Any:
    return ros_class(f"geometry_msgs/msg/{name}")


def _pose(x: float, y: float, phi: float) -> Any:
    turn = _geometry("Quaternion")(x=0.0, y=0.0, z=math.sin(phi / 2), w=math.cos(phi / 2))
    return _geometry("Pose")(position=_geometry("Point")(x=x, y=y, z=0.0), orientation=turn)


def _planar(pose: Any) -> tuple[float, float, float]:
    point, turn = pose.position, pose.orientation
    check_numbers(point.x, point.y, point.z, turn.x, turn.y, turn.z, turn.w)
    norm = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + turn.w * turn.w
    if abs(norm - 1) > UNIT_TOLERANCE:
        raise RefusedValueError(DecodeRefusal.NO_UNIT_QUATERNION)
    yaw = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y * turn.y + turn.z * turn.z))
    return point.x, point.y, yaw


def _twist(v: float, omega: float) -> Any:
    vector = _geometry("Vector3")
    return _geometry("Twist")(linear=vector(x=v, y=0.0, z=0.0), angular=vector(x=0.0, y=0.0, z=omega))


def _speeds(twist: Any) -> tuple[float, float]:
    linear, angular = twist.linear, twist.angular
    check_numbers(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
    return linear.x, angular.z


def velocity_to_ros(message: m.VelocityCommand) -> Any:
    """geometry_msgs/TwistStamped in base_link."""
    twist = _twist(message.v, message.omega)
    return _geometry("TwistStamped")(header=header(message.stamp_ns, "base_link"), twist=twist)


def velocity_from_ros(ros: Any) -> m.VelocityCommand:
    """Forward speed and turn rate of a TwistStamped; the other four must be finite."""
    return m.VelocityCommand(stamp_ns(ros.header), *_speeds(ros.twist))


def odometry_to_ros(message: m.Odometry) -> Any:
    """nav_msgs/Odometry: pose in odom, velocity in base_link, covariances unknown (zero)."""
    pose = _geometry("PoseWithCovariance")(pose=_pose(message.x, message.y, message.phi), covariance=np.zeros(36))
    twist = _geometry("TwistWithCovariance")(twist=_twist(message.v, message.omega), covariance=np.zeros(36))
    kind = ros_class("nav_msgs/msg/Odometry")
    return kind(header=header(message.stamp_ns, "odom"), child_frame_id="base_link", pose=pose, twist=twist)


def odometry_from_ros(ros: Any) -> m.Odometry:
    """The planar part of an Odometry."""
    check_array(ros.pose.covariance)
    check_array(ros.twist.covariance)
    return m.Odometry(stamp_ns(ros.header), *_planar(ros.pose.pose), *_speeds(ros.twist.twist))


def pose_to_ros(message: m.PoseEstimate) -> Any:
    """geometry_msgs/PoseWithCovarianceStamped in map."""
    covariance = np.zeros(36)
    covariance[[COVARIANCE_X, COVARIANCE_Y, COVARIANCE_YAW]] = message.var_x, message.var_y, message.var_phi
    pose = _geometry("PoseWithCovariance")(pose=_pose(message.x, message.y, message.phi), covariance=covariance)
    return _geometry("PoseWithCovarianceStamped")(header=header(message.stamp_ns, "map"), pose=pose)


def pose_from_ros(ros: Any) -> m.PoseEstimate:
    """Planar pose with the variances of x, y and yaw."""
    covariance = ros.pose.covariance
    check_array(covariance)
    variances = [float(covariance[i]) for i in (COVARIANCE_X, COVARIANCE_Y, COVARIANCE_YAW)]
    check_variances(*variances)
    return m.PoseEstimate(stamp_ns(ros.header), *_planar(ros.pose.pose), *variances)


def estop_to_ros(message: m.EStop) -> Any:
    """std_msgs/Bool."""
    return ros_class("std_msgs/msg/Bool")(data=message.stop)


def estop_from_ros(ros: Any) -> m.EStop:
    """The e-stop of a Bool; true stops."""
    return m.EStop(ros.data)


def clock_to_ros(message: m.Clock) -> Any:
    """rosgraph_msgs/Clock."""
    return ros_class("rosgraph_msgs/msg/Clock")(clock=time(message.stamp_ns))


def clock_from_ros(ros: Any) -> m.Clock:
    """The time of a Clock."""
    return m.Clock(time_ns(ros.clock))


def joints_to_ros(message: m.JointState) -> Any:
    """sensor_msgs/JointState; it has no frame."""
    positions, velocities, efforts = map(np.array, (message.positions, message.velocities, message.efforts))
    kind = ros_class("sensor_msgs/msg/JointState")
    return kind(
        header=header(message.stamp_ns, ""),
        name=list(message.names),
        position=positions.astype(np.float64),
        velocity=velocities.astype(np.float64),
        effort=efforts.astype(np.float64),
    )


def joints_from_ros(ros: Any) -> m.JointState:
    """Joint state with all values; a message that leaves out velocities or efforts is refused."""
    columns = (ros.position, ros.velocity, ros.effort)
    for column in columns:
        check_array(column)
    if any(len(column) != len(ros.name) for column in columns):
        raise RefusedValueError(DecodeRefusal.JOINT_LACKS_VALUE)
    return m.JointState(stamp_ns(ros.header), tuple(ros.name), *(tuple(column.tolist()) for column in columns))


CONVERTERS: dict[type, tuple[Any, Any]] = {
    m.VelocityCommand: (velocity_to_ros, velocity_from_ros),
    m.Odometry: (odometry_to_ros, odometry_from_ros),
    m.PoseEstimate: (pose_to_ros, pose_from_ros),
    m.EStop: (estop_to_ros, estop_from_ros),
    m.Clock: (clock_to_ros, clock_from_ros),
    m.JointState: (joints_to_ros, joints_from_ros),
}
