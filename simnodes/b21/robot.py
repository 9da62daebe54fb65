"""The robot in PyBullet: b21.urdf, its motors, and what its joints do."""

from __future__ import annotations

import math
from collections.abc import Sequence
from importlib import resources
from typing import Any

from tailor.schemas.kitchen.kinematics import JOINTS
from tailor.simnodes.b21.engine import pybullet
from tailor.simnodes.b21.firmware import Firmware
from tailor.simnodes.b21.physical_parameters import PhysicalParameters

BASE = ("x", "y", "yaw")
FINGERS = ("left", "right")


class Robot:
    """Base, arm and gripper.

    Attributes:
      body: Its number in PyBullet.
      hand: Link that carries the gripper.
      fingers: Links of the two fingers.
      angles, rates: Of the arm's joints, rad and rad/s.
      x, y, phi: Pose of the base in the map frame.
      v, omega: Velocity of the base, m/s and rad/s.
      width: Between the fingers, m.
      squeeze_n: Force of the weaker finger's motor, N.
    """

    def __init__(self, client: int, parameters: PhysicalParameters) -> None:
        """Load it at the origin."""
        self._bullet = pybullet()
        self._where: dict[str, Any] = {"physicsClientId": client}
        with resources.as_file(resources.files(__package__) / "b21.urdf") as file:
            self.body: int = self._bullet.loadURDF(str(file), useFixedBase=True, **self._where)
        count = self._bullet.getNumJoints(self.body, **self._where)
        infos = [self._bullet.getJointInfo(self.body, joint, **self._where) for joint in range(count)]
        number = {info[1].decode(): info[0] for info in infos}
        self._base, self._arm = [number[name] for name in BASE], [number[name] for name in JOINTS]
        self.fingers = (number["left"], number["right"])
        self.hand = number["hand"]
        self._moved = [*self._arm, *self.fingers]
        self._all = [*self._base, *self._moved]
        self._forces = [*parameters.joint_nm, parameters.grip_n, parameters.grip_n]
        self._base_forces = [parameters.drive_n, parameters.drive_n, parameters.turn_nm]
        self._sent_base: list[float] = []
        self._sent_moved: list[float] = []
        self._gains = [parameters.joint_gain] * len(self._moved)
        for joint in range(count):
            self._bullet.changeDynamics(self.body, joint, linearDamping=0.0, angularDamping=0.0, **self._where)
        for finger in self.fingers:
            self._bullet.changeDynamics(self.body, finger, lateralFriction=1.0, **self._where)
        self.read()

    def place(self, pose: Sequence[float], v: float, omega: float, angles: Sequence[float], width: float) -> None:
        """Put the robot somewhere; the base in motion, the arm at rest."""
        x, y, phi = pose
        motion = ((x, v * math.cos(phi)), (y, v * math.sin(phi)), (phi, omega))
        still = [(angle, 0.0) for angle in angles] + [(width / 2, 0.0)] * len(self.fingers)
        for joint, (angle, rate) in zip(self._all, (*motion, *still), strict=True):
            self._bullet.resetJointState(self.body, joint, angle, rate, **self._where)
        self.read()

    def drive(self, firmware: Firmware, width: float | None) -> None:
        """Hand the set-points to the motors, which keep them: only those that have changed.

        Args:
          firmware: Set-points of this period.
          width: Of the gripper, where something between the fingers fixes it; None: the firmware's.
        """
        # midway through the period, so that a turning base follows its circle
        phi = self.phi + 0.005 * firmware.omega
        base = [firmware.v * math.cos(phi), firmware.v * math.sin(phi), firmware.omega]
        if base != self._sent_base:
            self._sent_base = base
            self._bullet.setJointMotorControlArray(
                self.body,
                self._base,
                self._bullet.VELOCITY_CONTROL,
                targetVelocities=base,
                forces=self._base_forces,
                **self._where,
            )
        finger = 0.5 * (firmware.width if width is None else width)
        rate = 0.5 * firmware.width_rate if width is None else 0.0
        moved = [*firmware.angles, finger, finger, *firmware.velocities, rate, rate]
        if moved != self._sent_moved:
            self._sent_moved = moved
            self._bullet.setJointMotorControlArray(
                self.body,
                self._moved,
                self._bullet.POSITION_CONTROL,
                targetPositions=moved[: len(self._moved)],
                targetVelocities=moved[len(self._moved) :],
                forces=self._forces,
                positionGains=self._gains,
                **self._where,
            )

    def read(self) -> None:
        """Take over the joints' states after a step."""
        states = self._bullet.getJointStates(self.body, self._all, **self._where)
        (self.x, vx, *_), (self.y, vy, *_), (yaw, self.omega, *_) = states[:3]
        self.phi = math.remainder(yaw, math.tau)
        self.v = vx * math.cos(yaw) + vy * math.sin(yaw)
        self.angles = tuple([state[0] for state in states[3:-2]])
        self.rates = tuple([state[1] for state in states[3:-2]])
        left, right = states[-2:]
        self.width = left[0] + right[0]
        self.squeeze_n = min(abs(left[3]), abs(right[3]))

    def contacts(self) -> Any:
        """Contacts of any part of the robot in the last step, as PyBullet lists them."""
        return self._bullet.getContactPoints(bodyA=self.body, **self._where)
