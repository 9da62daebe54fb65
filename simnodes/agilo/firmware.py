"""The motor board: slews velocity set-points at 50 Hz and keeps them within the limits of the drive."""

from __future__ import annotations

PERIOD_NS = 20_000_000
PERIOD_S = PERIOD_NS * 1e-9
V_MAX_MPS = 0.9
OMEGA_MAX_RADPS = 1.75
RIM_MAX_MPS = 1.2  # of either wheel
SPEED_UP_MPS2 = 0.5
SLOW_DOWN_MPS2 = 0.65
YAW_RADPS2 = 1.75


class Firmware:
    """Velocity limiter of a differential drive; call `tick` once a period.

    Attributes:
      v, omega: Present set-points of the wheel servos, m/s and rad/s.
    """

    def __init__(self, track_m: float) -> None:
        self._half_track_m = track_m / 2
        self.v = 0.0
        self.omega = 0.0
        self._target = (0.0, 0.0)

    def reset(self, v: float, omega: float) -> None:
        """Start in motion with these set-points (m/s, rad/s)."""
        self.v, self.omega = v, omega
        self._target = (v, omega)

    def accept(self, v: float, omega: float) -> None:
        """Take a new set-point (m/s, rad/s); it is clamped to the drive's limits."""
        omega = max(-OMEGA_MAX_RADPS, min(OMEGA_MAX_RADPS, omega))
        v_rim = RIM_MAX_MPS - abs(omega) * self._half_track_m
        v_limit = min(V_MAX_MPS, v_rim)
        self._target = (max(-v_limit, min(v_limit, v)), omega)

    def tick(self) -> tuple[float, float]:
        """Advance one period and return the set-points (m/s, rad/s) for the wheel servos."""
        v, omega = self._target
        rate = SPEED_UP_MPS2 if abs(v) > abs(self.v) and v * self.v >= 0.0 else SLOW_DOWN_MPS2
        self.v += _towards(v - self.v, rate * PERIOD_S)
        self.omega += _towards(omega - self.omega, YAW_RADPS2 * PERIOD_S)
        return self.v, self.omega


def _towards(difference: float, step: float) -> float:
    return step if difference > step else -step if difference < -step else difference
