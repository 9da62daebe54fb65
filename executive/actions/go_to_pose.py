"""goToPose: drive to a pose and arrive there with a given speed. Knows nothing of balls or obstacles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

from executive.actions.planar import VG, XG, PlanarBelief
from executive.belief.angles import difference
from executive.library import Array, Control

Phase = Literal["drive", "align"]


@dataclass(frozen=True, slots=True)
class GoToPose:
    """Steers to a point on the goal's line that wanders from behind the goal past it; turns on the spot at last.

    The point stays `look_m` ahead near the goal: steered at the goal itself, a few centimetres of noise beside it would
    swing the robot round right where it is to face ahead.

    The memory is the phase: with its hysteresis noise cannot toggle driving and turning.
    """

    v_max_mps: float
    omega_max_radps: float
    lead: float = 0.25  # the point to steer to lies this share of the distance behind the goal,
    look_m: float = 0.35  # but never nearer than this
    steer_gain: float = 2.8  # rad/s per rad of heading error
    slow_in_turns: float = 1.5  # exponent of the cosine of the heading error
    braking_mps2: float = 0.55  # what the motor board does, with a reserve
    near_m: float = 0.15  # so close to the goal only the heading is left to correct
    settle_m: float = 0.08  # the goal's speed is reached so far before it
    stay_m: float = 0.30  # turning on the spot may have carried it so far
    reached_m: float = 0.03  # along the goal's heading
    heading_rad: float = 0.20
    aligned_rad: float = 0.10  # turning on the spot goes on until here
    stopping_radps2: float = 1.3  # what the motor board does, with a reserve
    still_radps: float = 0.4
    speed_mps: float = 0.10  # by which the arrival may be too fast

    def __call__(self, memory: Any, now_ns: int, belief: PlanarBelief, arguments: Array) -> Control:
        """See executive.library.Controller; the command is (v m/s, omega rad/s)."""
        xg, yg, phig, vg = arguments[XG : VG + 1].tolist()
        pose = belief.pose
        dx, dy = xg - pose.x, yg - pose.y
        distance = math.hypot(dx, dy)
        off = difference(phig, pose.phi)
        if self._arrived(belief, distance, dx * math.cos(phig) + dy * math.sin(phig), off, vg, memory):
            return Control(memory, (vg, 0.0), "done")
        if self._phase(memory, distance, off) == "align":
            return Control("align", (0.0, self._turn(off)))
        behind = min(self.lead * distance, distance - self.look_m)
        error = difference(math.atan2(dy - behind * math.sin(phig), dx - behind * math.cos(phig)), pose.phi)
        v_end = vg * max(0.0, math.cos(off)) ** 2  # headed wrongly, it will have to stop and turn
        return Control("drive", (self._speed(distance, error, v_end), self._steer(error)))

    def _phase(self, phase: Phase | None, distance: float, off: float) -> Phase:
        if phase == "align":
            return "align" if distance < self.stay_m else "drive"
        return "align" if distance < self.near_m and abs(off) > self.heading_rad else "drive"

    def _arrived(
        self, belief: PlanarBelief, distance: float, along: float, off: float, vg: float, phase: Phase | None
    ) -> bool:
        """Near enough, headed right, and past the goal's line or done with turning; not too fast."""
        if belief.v > vg + self.speed_mps:
            return False
        if phase == "align":
            return abs(off) < self.aligned_rad and abs(belief.omega) < self.still_radps and distance < self.stay_m
        return distance < self.near_m and along < self.reached_m and abs(off) < self.heading_rad

    def _turn(self, off: float) -> float:
        """Turning on the spot so that it can be stopped in time."""
        return math.copysign(min(abs(self._steer(off)), math.sqrt(2 * self.stopping_radps2 * abs(off))), off)

    def _steer(self, error: float) -> float:
        return max(-self.omega_max_radps, min(self.omega_max_radps, self.steer_gain * error))

    def _speed(self, distance: float, error: float, v_end: float) -> float:
        facing = math.pow(max(0.0, math.cos(error)), self.slow_in_turns)
        rest = max(0.0, distance - self.settle_m)
        # never slower than a crawl, or it would not arrive
        return min(self.v_max_mps * facing, max(0.1, math.sqrt(v_end * v_end + 2 * self.braking_mps2 * rest)))
