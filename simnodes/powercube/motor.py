"""Driver of one motor: interpolates velocity set-points and converts them to current, at 1 kHz.

It keeps speed, acceleration, angle and current within their limits for any set-point.
"""

from __future__ import annotations

import math

from tailor.simnodes.powercube.physical_parameters import PhysicalParameters

PERIOD_NS = 1_000_000
PERIOD_S = PERIOD_NS * 1e-9
INTERPOLATION_S = 0.1  # set-points arrive at 10 Hz and are joined by straight lines
STIFFNESS_A_PER_RAD = 400.0  # closes the angle at about 6 Hz
DAMPING_A_PER_RADPS = 16.0
TACHO_S = 0.004  # time constant of the velocity from the encoder
MAX_LEAD_RAD = 0.05  # of the inner set-point over a saturated motor
END_BRAKING_RADPS2 = 2.0  # before the end of the angle's range


class Motor:
    """A velocity servo over a current limit; `tick` is called once a period with the encoder's count."""

    def __init__(self, parameters: PhysicalParameters) -> None:
        self._p = parameters
        self._limit_a = parameters.current_max_a
        self._step_max = parameters.acceleration_max_radps2 * PERIOD_S
        self.reset(0.0, 0.0, 0.0)

    def reset(self, angle: float, velocity: float, current_a: float) -> None:
        """Start in motion (rad, rad/s), carrying a load that needs `current_a` (A)."""
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
        """Advance one period.

        Args:
          angle: Joint angle from the encoder, rad.

        Returns:
          Motor current, A.
        """
        self.tacho += ((angle - self._last) / PERIOD_S - self.tacho) * (PERIOD_S / TACHO_S)
        self._last = angle
        step, change = self._step, self._target - self.velocity
        if not -step <= change <= step:
            change = step if change > 0.0 else -step
        velocity = self.velocity = self._limited_near_end(angle, self.velocity + change)
        lead = self._inner + velocity * PERIOD_S - angle
        if not -MAX_LEAD_RAD <= lead <= MAX_LEAD_RAD:
            lead = MAX_LEAD_RAD if lead > 0.0 else -MAX_LEAD_RAD
        self._inner = angle + lead
        current, limit = STIFFNESS_A_PER_RAD * lead + DAMPING_A_PER_RADPS * (velocity - self.tacho), self._limit_a
        if not -limit <= current <= limit:
            current = limit if current > 0.0 else -limit
        self.current_a = current
        return current

    def _limited_near_end(self, angle: float, velocity: float) -> float:
        """The velocity, limited so that the arm can stop within its range."""
        room = self._p.position_max_rad - (angle if velocity > 0.0 else -angle)
        if room > 0.5 * velocity * velocity / END_BRAKING_RADPS2:
            return velocity
        return math.copysign(math.sqrt(2 * END_BRAKING_RADPS2 * max(0.0, room)), velocity)
