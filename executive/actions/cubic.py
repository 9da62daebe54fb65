"""The cubic between two states of a set of joints, and how long it is to take.

Among all motions that take T seconds between two angles with given velocities the cubic has the least ∫|q̈|² dt. T
itself minimises T + ∫|q̈|² dt / A²: a smooth function of both states, and one that any later point of the motion
confirms. From rest to rest the largest acceleration is then A, over any distance. Each joint may have its own A.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

Joints = tuple[float, ...]  # one number a joint: rad, rad/s or rad/s²

MIN_S = 0.05
MAX_S = 40.0
STEPS = 60  # of the search for the best duration, evenly spaced in its logarithm
HALVINGS = 50  # until the duration is exact to the last bits


@dataclass(frozen=True, slots=True)
class Cubic:
    """q(t) = q0 + v0·t + b·t² + c·t³ for 0 <= t <= duration_s."""

    q0: Joints
    v0: Joints
    b: Joints
    c: Joints
    duration_s: float

    def angles(self, t: float) -> Joints:
        """Angles at `t` seconds, held within the motion."""
        t = max(0.0, min(self.duration_s, t))
        rows = zip(self.q0, self.v0, self.b, self.c, strict=True)
        return tuple(q0 + t * (v0 + t * (b + t * c)) for q0, v0, b, c in rows)

    def velocities(self, t: float) -> Joints:
        """Angular velocities at `t` seconds, held within the motion."""
        t = max(0.0, min(self.duration_s, t))
        return tuple(v0 + t * (2 * b + t * 3 * c) for v0, b, c in zip(self.v0, self.b, self.c, strict=True))

    @property
    def peak_acceleration(self) -> float:
        """Largest |q̈|, rad/s²: acceleration is linear in time, so it is largest at one of the ends."""
        begin = math.hypot(*(2 * b for b in self.b))
        end = math.hypot(*(2 * b + 6 * c * self.duration_s for b, c in zip(self.b, self.c, strict=True)))
        return max(begin, end)

    @property
    def peak_velocity(self) -> float:
        """Largest |q̇| of any joint, rad/s: at an end, or where the joint's acceleration is 0."""
        ends = (*map(abs, self.v0), *map(abs, self.velocities(self.duration_s)))
        turns = ((-b / (3 * c), v0 - b * b / (3 * c)) for v0, b, c in zip(self.v0, self.b, self.c, strict=True) if c)
        return max(*ends, *(abs(v) for t, v in turns if 0.0 < t < self.duration_s))


def cubic(q0: Joints, v0: Joints, q1: Joints, v1: Joints, duration_s: float) -> Cubic:
    """The cubic from (q0, v0) to (q1, v1) that takes `duration_s` > 0."""
    rate = 1.0 / duration_s
    b, c = [], []
    for start, leave, goal, arrive in zip(q0, v0, q1, v1, strict=True):
        mean = (goal - start) * rate
        b.append((3 * mean - 2 * leave - arrive) * rate)
        c.append((leave + arrive - 2 * mean) * rate * rate)
    return Cubic(q0, v0, tuple(b), tuple(c), duration_s)


def best_duration_s(q0: Joints, v0: Joints, q1: Joints, v1: Joints, accelerations: Joints) -> float:
    """The T that minimises T + Σ ∫q̈² dt / A² over the joints, A in rad/s²; between MIN_S and MAX_S.

    With u = 1/T the integral is e1·u + e2·u² + e3·u³, so that the slope of the cost over T is 1 - slope(u).
    """
    e1 = e2 = e3 = 0.0
    for start, leave, goal, arrive, acceleration in zip(q0, v0, q1, v1, accelerations, strict=True):
        way, weight = goal - start, 1.0 / (acceleration * acceleration)
        e1 += 4 * weight * (leave * leave + leave * arrive + arrive * arrive)
        e2 -= 12 * weight * way * (leave + arrive)
        e3 += 12 * weight * way * way

    def cost(u: float) -> float:
        return 1.0 / u + u * (e1 + u * (e2 + u * e3))

    def slope(u: float) -> float:
        return u * u * (e1 + u * (2 * e2 + u * 3 * e3))

    ratio: float = (MAX_S / MIN_S) ** (1.0 / STEPS)
    best = min((ratio**k / MAX_S for k in range(STEPS + 1)), key=cost)
    low, high = max(best / ratio, 1.0 / MAX_S), min(best * ratio, 1.0 / MIN_S)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if slope(middle) < 1.0 else (low, middle)
    return 1.0 / low
