"""The motor boards: slew the set-points of base, arm and gripper every 10 ms and keep them within their limits."""

from __future__ import annotations

from collections.abc import Sequence

from tailor.schemas.kitchen.kinematics import (
    ARM,
    GRIPPER_MAX_M,
    GRIPPER_MPS,
    JOINT_MAX_RADPS,
    OMEGA_MAX_RADPS,
    V_MAX_MPS,
)
from tailor.simnodes.body import STEP_NS

PERIOD_S = STEP_NS * 1e-9
SPEED_UP_MPS2 = 0.5
SLOW_DOWN_MPS2 = 0.6
YAW_RADPS2 = 1.5
JOINT_RADPS2 = 4.0
MAX_LEAD_RAD = 0.05  # of a joint's set-point over a joint that something blocks
MAX_SQUEEZE_M = 0.004  # of the gripper's set-point into what is between the fingers


class Firmware:
    """Limiter of nine axes; call `tick` once every 10 ms.

    Attributes:
      v, omega: Present set-points of the base, m/s and rad/s.
      velocities, angles: Present set-points of the joints, rad/s and rad.
      width, width_rate: Present set-point of the gripper, m, and how fast it changes, m/s.
      target_width: Where the gripper is to go.
    """

    def __init__(self) -> None:
        self.reset(0.0, 0.0, (0.0,) * len(ARM), GRIPPER_MAX_M)

    def reset(self, v: float, omega: float, angles: Sequence[float], width: float) -> None:
        """Start in motion with these set-points; the arm is at rest."""
        self.v, self.omega = v, omega
        self.angles, self.velocities = list(angles), [0.0] * len(ARM)
        self.width = self.target_width = width
        self.width_rate = 0.0
        self._base = (v, omega)
        self._joints: tuple[float, ...] = (0.0,) * len(ARM)
        self._moving = False  # an arm at rest keeps its set-points

    def accept(self, values: Sequence[float]) -> None:
        """Take set-points of all axes in the order of driver.toml; they are clamped to the limits."""
        v, omega, *joints, width = values
        self._base = (_clamped(v, V_MAX_MPS), _clamped(omega, OMEGA_MAX_RADPS))
        self._joints = tuple(_clamped(rate, JOINT_MAX_RADPS) for rate in joints)
        self._moving = self._moving or any(self._joints)
        self.target_width = max(0.0, min(GRIPPER_MAX_M, width))

    def tick(self, angles: Sequence[float], width: float) -> None:
        """Advance one period; the measured angles (rad) and width (m) bound how far set-points run ahead."""
        v, omega = self._base
        rate = SPEED_UP_MPS2 if abs(v) > abs(self.v) and v * self.v >= 0.0 else SLOW_DOWN_MPS2
        self.v += _clamped(v - self.v, rate * PERIOD_S)
        self.omega += _clamped(omega - self.omega, YAW_RADPS2 * PERIOD_S)
        if self._moving:
            self._move_arm(angles)
        wanted = self.width + _clamped(self.target_width - self.width, GRIPPER_MPS * PERIOD_S)
        before, self.width = self.width, max(wanted, width - MAX_SQUEEZE_M)
        self.width_rate = (self.width - before) / PERIOD_S

    def _move_arm(self, angles: Sequence[float]) -> None:
        for k, joint in enumerate(ARM):
            velocity = self.velocities[k] + _clamped(self._joints[k] - self.velocities[k], JOINT_RADPS2 * PERIOD_S)
            ahead = self.angles[k] + velocity * PERIOD_S
            ahead = angles[k] + _clamped(ahead - angles[k], MAX_LEAD_RAD)
            within = max(joint.lower, min(joint.upper, ahead))
            self.angles[k] = within
            self.velocities[k] = velocity if within == ahead else 0.0
        self._moving = any(self._joints) or any(self.velocities)


def _clamped(value: float, most: float) -> float:
    return most if value > most else -most if value < -most else value
