"""Error models of the B21's sensors: odometry, pose, joints, gripper, and a camera that finds objects.

Every random number comes from the generator of `Sensors.reset`, and as many in each picture whatever it shows.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from tailor.schemas.kitchen.kinematics import HALF_VIEW_RAD, JOINTS, VIEW_M
from tailor.schemas.messages import JointState, Odometry, PoseEstimate
from tailor.schemas.messages.kitchen import GripperState, KitchenObject, ObjectPercept, ObjectPercepts

MIN_VARIANCE = 1e-8  # of what is exact: filters divide by variances
POSE_PERIOD_S = 0.08


@dataclass(frozen=True, slots=True)
class Sensing:
    """Parameters of the error models; the defaults are the paper's Table 5: the robot knows itself exactly."""

    pose_sigma_m: float = 0.0
    pose_sigma_rad: float = 0.0
    pose_correlation_s: float = 0.6
    pose_dropout: float = 0.0
    odom_scale: float = 0.0  # one draw a reset
    odom_v_mps: float = 0.0
    odom_omega_radps: float = 0.0
    joint_offset_rad: float = 0.0  # one draw a reset and joint: calibration
    joint_sigma_rad: float = 0.0
    joint_rate_sigma_radps: float = 0.0
    width_sigma_m: float = 0.0
    force_sigma_n: float = 0.0
    object_base_m: float = 0.002
    object_share: float = 0.002  # of the distance
    object_rad: float = 0.02
    object_dropout: float = 0.03


class Sensors:
    """Converts true states to messages."""

    def __init__(self, sensing: Sensing) -> None:
        self._s = sensing
        self._correlation = math.exp(-POSE_PERIOD_S / sensing.pose_correlation_s)
        self._innovation = math.sqrt(1.0 - self._correlation**2)
        self.reset(np.random.default_rng(0))

    def reset(self, rng: np.random.Generator) -> None:
        """Start anew with this source of noise; errors start in their stationary distribution."""
        self._normal = _normals(rng).__next__
        self._pose_error = [self._normal() for _ in range(3)]
        self._scales = [1.0 + self._s.odom_scale * self._normal() for _ in range(2)]
        self._offsets = [self._s.joint_offset_rad * self._normal() for _ in JOINTS]
        self._odom = (0.0, 0.0, 0.0)

    def odometry(self, stamp_ns: int, v: float, omega: float, period_s: float) -> Odometry:
        """Velocities (m/s, rad/s) as the encoders measure them, and their integral since the reset."""
        v = v * self._scales[0] + self._s.odom_v_mps * self._normal()
        omega = omega * self._scales[1] + self._s.odom_omega_radps * self._normal()
        x, y, phi = self._odom
        middle = phi + 0.5 * omega * period_s
        x, y = x + v * period_s * math.cos(middle), y + v * period_s * math.sin(middle)
        phi = math.remainder(phi + omega * period_s, math.tau)
        self._odom = (x, y, phi)
        return Odometry(stamp_ns, x, y, phi, v, omega)

    def pose(self, stamp_ns: int, x: float, y: float, phi: float) -> PoseEstimate | None:
        """Pose as the localiser measures it; None if the measurement is lost."""
        error, s = self._pose_error, self._s
        for axis in range(3):
            error[axis] = self._correlation * error[axis] + self._innovation * self._normal()
        if self._lost(s.pose_dropout):
            return None
        x, y = x + s.pose_sigma_m * error[0], y + s.pose_sigma_m * error[1]
        phi = math.remainder(phi + s.pose_sigma_rad * error[2], math.tau)
        var, var_phi = max(MIN_VARIANCE, s.pose_sigma_m**2), max(MIN_VARIANCE, s.pose_sigma_rad**2)
        return PoseEstimate(stamp_ns, x, y, phi, var, var, var_phi)

    def joints(self, stamp_ns: int, angles: Iterable[float], rates: Iterable[float]) -> JointState:
        """Angles (rad) and velocities (rad/s) of the arm."""
        s, normal = self._s, self._normal
        rows = zip(angles, self._offsets, strict=True)
        measured = tuple(angle + offset + s.joint_sigma_rad * normal() for angle, offset in rows)
        moving = tuple(rate + s.joint_rate_sigma_radps * normal() for rate in rates)
        return JointState(stamp_ns, JOINTS, measured, moving, (0.0,) * len(JOINTS))

    def gripper(self, stamp_ns: int, width: float, force_n: float) -> GripperState:
        """Width (m) and force (N) of the gripper."""
        width += self._s.width_sigma_m * self._normal()
        return GripperState(stamp_ns, width, max(0.0, force_n + self._s.force_sigma_n * self._normal()))

    def objects(
        self, stamp_ns: int, pose: tuple[float, float, float], standing: Iterable[KitchenObject]
    ) -> ObjectPercepts:
        """The objects (map frame) that a picture from a pose (m, m, rad) shows; none hides another one."""
        found = (self._object(pose, each) for each in standing)
        return ObjectPercepts(stamp_ns, tuple(percept for percept in found if percept is not None))

    def _object(self, pose: tuple[float, float, float], each: KitchenObject) -> ObjectPercept | None:
        s, errors = self._s, [self._normal() for _ in range(5)]
        lost = self._lost(s.object_dropout)
        dx, dy = each.x - pose[0], each.y - pose[1]
        c, sine = math.cos(pose[2]), math.sin(pose[2])
        ahead, left = c * dx + sine * dy, c * dy - sine * dx
        distance = math.hypot(ahead, left)
        if lost or not VIEW_M[0] < distance < VIEW_M[1] or abs(math.atan2(left, ahead)) > HALF_VIEW_RAD:
            return None
        sigma = s.object_base_m + s.object_share * distance
        phi = math.remainder(each.phi - pose[2] + s.object_rad * errors[3], math.tau)
        return ObjectPercept(
            each.name,
            ahead + sigma * errors[0],
            left + sigma * errors[1],
            each.z + sigma * errors[2],
            phi,
            abs(each.tilt + s.object_rad * errors[4]),
            max(MIN_VARIANCE, sigma**2),
            max(MIN_VARIANCE, sigma**2),
            max(MIN_VARIANCE, s.object_rad**2),
        )

    def _lost(self, share: float) -> bool:
        return 0.5 * math.erfc(self._normal() / math.sqrt(2.0)) < share


def _normals(rng: np.random.Generator) -> Iterator[float]:
    """Standard normal numbers; drawn in blocks when they are needed, which is ten times faster."""
    while True:
        yield from reversed(rng.standard_normal(512).tolist())
