"""One motor's driver: interpolates velocity set-points and turns them into current, at 1 kHz.

Stays within speed, acceleration, angle and current limits by itself, whatever it is told.
"""

from __future__ import annotations

import math

from tailor.simnodes.powercube.physical_parameters import PhysicalParameters

PERIOD_NS = 1_000_000
PERIOD_S = PERIOD_NS * 1e-9
INTERPOLATION_S = 0.1  # set-points come at 10 Hz and are joined by straight lines
STIFFNESS_A_PER_RAD = 400.0  # closes the angle at about 6 Hz
DAMPING_A_PER_RADPS = 16.0
TACHO_S = 0.004  # time constant of the velocity that is read off the encoder
LEASH_RAD = 0.05  # so far the inner set-point may run ahead of a saturated motor
END_BRAKING_RADPS2 = 2.0  # before the end of the angle's range


class Motor:
    """A velocity servo over a current limit; `tick` is called once a period with the encoder's count."""

    def __init__(self, physical_parameters: PhysicalParameters) -> None:
        self._p = physical_parameters
        self._count_rad = physical_parameters.count_rad
        self._step_max = physical_parameters.acceleration_max_radps2 * PERIOD_S
        self.reset(0.0, 0.0, 0.0)

    def reset(self, angle: float, velocity: float, current_a: float) -> None:
        """Start in motion (rad, rad/s), carrying a load that takes `current_a`."""
        self._target = self.velocity = velocity
        self._step = 0.0
        self._inner = angle + current_a / STIFFNESS_A_PER_RAD
        self._last = angle
        self.tacho = velocity
        self.current_a = current_a

    def accept(self, velocity: float) -> None:
        """Take a set-point (rad/s), reached in INTERPOLATION_S at the earliest; the same one again changes nothing."""
        limit = self._p.velocity_max_radps
        target = max(-limit, min(limit, velocity))
        if target == self._target:
            return
        self._target = target
        self._step = min(self._step_max, abs(target - self.velocity) / INTERPOLATION_S * PERIOD_S)

    def tick(self, angle: float) -> float:
        """One period on; the current (A) for an angle as the encoder says it (rad)."""
        self.tacho += ((angle - self._last) / PERIOD_S - self.tacho) * (PERIOD_S / TACHO_S)
        self._last = angle
        left = self._target - self.velocity
        self.velocity += max(-self._step, min(self._step, left))
        self.velocity = self._before_the_end(angle, self.velocity)
        inner = self._inner + self.velocity * PERIOD_S
        self._inner = max(angle - LEASH_RAD, min(angle + LEASH_RAD, inner))
        current = STIFFNESS_A_PER_RAD * (self._inner - angle) + DAMPING_A_PER_RADPS * (self.velocity - self.tacho)
        limit = self._p.current_max_a
        self.current_a = max(-limit, min(limit, current))
        return self.current_a

    def _before_the_end(self, angle: float, velocity: float) -> float:
        """No faster than the arm can still be stopped within its range."""
        room = self._p.position_max_rad - (angle if velocity > 0.0 else -angle)
        if room > 0.5 * velocity * velocity / END_BRAKING_RADPS2:
            return velocity
        return math.copysign(math.sqrt(2 * END_BRAKING_RADPS2 * max(0.0, room)), velocity)
