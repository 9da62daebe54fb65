"""Error models of the B21's sensors: odometry, pose, joints, gripper, and a camera that finds objects.

Every random number comes from the generator of `Sensors.reset`, and as many in each picture whatever it shows.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tailor.schemas.kitchen.kinematics import HALF_VIEW_RAD, JOINTS, VIEW_M
from tailor.schemas.messages import JointState
from tailor.schemas.messages.kitchen import GripperState, KitchenObject, ObjectPercept, ObjectPercepts
from tailor.simnodes.planar_sensing import MIN_VARIANCE, PlanarSensing, PlanarSensors


@dataclass(frozen=True, slots=True)
class Sensing(PlanarSensing):
    """Parameters of the error models; the defaults are the paper's Table 5: the robot knows itself exactly."""

    joint_offset_rad: float = 0.0  # one draw a reset and joint: calibration
    joint_sigma_rad: float = 0.0
    joint_rate_sigma_radps: float = 0.0
    width_sigma_m: float = 0.0
    force_sigma_n: float = 0.0
    object_base_m: float = 0.002
    object_share: float = 0.002  # of the distance
    object_rad: float = 0.02
    object_dropout: float = 0.03


class Sensors(PlanarSensors):
    """Converts true states to messages."""

    def __init__(self, sensing: Sensing) -> None:
        self._s = sensing
        super().__init__(sensing)

    def reset(self, rng: np.random.Generator) -> None:
        """See PlanarSensors.reset."""
        super().reset(rng)
        self._offsets = [self._s.joint_offset_rad * self._normal() for _ in JOINTS]

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
