"""Ways around what stands there as an engineer computes them: a graph of poses beside it, joined by clear legs.

Legs are the ways which goToPose drives. Two poses between start and goal are enough for the scenarios.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive.actions.dubins import Pose2
from tailor.executive.interfaces.values import Array
from tailor.tools.evaluations.detours.geometry import LONG, RADIUS, WIDE, Geometry, X, Y, distances
from tailor.tools.evaluations.detours.legs import Legs

AROUND = 16  # poses around a cylinder, in both directions each

Way = tuple[float, tuple[Pose2, ...]]  # seconds, poses, the goal last


@dataclass(frozen=True, slots=True)
class DetourGraph:
    """Poses around cylinders, and the ways between them.

    Attributes:
      legs: Ways of the controller that drives.
      geometry: The robot.
      objects: What stands there, shape (m, 7): see geometry.py.
      field: Half the length and half the width of where poses may lie, m.
      margin_m: Distance that the robot keeps from it.
    """

    legs: Legs
    geometry: Geometry
    objects: Array
    field: tuple[float, float]
    margin_m: float

    def quickest(self, start: Pose2, goals: Sequence[Pose2], goal_mps: float) -> tuple[Pose2, ...] | None:
        """Poses on the quickest way that stays clear, the goal last; None if there is no such way.

        Of goals that are reached without poses before them the quickest is taken.
        """
        direct = self._legs_from(start, goals, goal_mps)
        if direct:
            return (min(direct)[1],)
        poses = list(self._poses())
        begun = self._legs_from(start, poses, self.geometry.passing_mps)
        ended: dict[Pose2, tuple[float, Pose2]] = {}
        for pose in poses:
            if last := self._legs_from(pose, goals, goal_mps):
                ended[pose] = min(last)
        single = [(s + ended[p][0], (p, ended[p][1])) for s, p in begun if p in ended]
        best: Way = min(single, default=(math.inf, ()))
        return self._with_two(begun, ended, best)[1] or None

    def is_clear(self, stops: Sequence[Pose2], goal_mps: float) -> bool:
        """Whether the way over these poses, the goal last, stays clear of everything."""
        speeds = [self.geometry.passing_mps] * (len(stops) - 2) + [goal_mps]
        return all(self._leg(a, b, v) is not None for a, b, v in zip(stops, stops[1:], speeds, strict=False))

    def _legs_from(self, start: Pose2, goals: Sequence[Pose2], goal_mps: float) -> list[tuple[float, Pose2]]:
        """Seconds to the goals that are reached without touching anything."""
        return [(s, goal) for goal in goals if (s := self._leg(start, goal, goal_mps)) is not None]

    def _with_two(
        self, begun: Sequence[tuple[float, Pose2]], ended: Mapping[Pose2, tuple[float, Pose2]], best: Way
    ) -> Way:
        """The best way over two poses, if it is better; bounded below by the straight distance."""
        mean_mps, passing_mps = self.geometry.mean_mps, self.geometry.passing_mps
        pairs = sorted((s + math.dist(p[:2], q[:2]) / mean_mps + ended[q][0], s, p, q) for s, p in begun for q in ended)
        for bound, s, p, q in pairs:
            if bound >= best[0]:
                break
            middle = self._leg(p, q, passing_mps)
            if middle is not None and s + middle + ended[q][0] < best[0]:
                best = s + middle + ended[q][0], (p, q, ended[q][1])
        return best

    def _poses(self) -> Iterator[Pose2]:
        """Beside each cylinder, along its edge."""
        keep_m = self.geometry.circles[0].radius_m + self.margin_m
        for x, y, radius in self.objects[(self.objects[:, [LONG, WIDE]] == 0.0).all(1)][:, [X, Y, RADIUS]].tolist():
            from_m = radius + self.geometry.circles[0].radius_m + self.geometry.margins_m[0] + self.geometry.spare_m
            for k in range(AROUND):
                angle = math.tau * k / AROUND
                at = x + from_m * math.cos(angle), y + from_m * math.sin(angle)
                inside = abs(at[0]) <= self.field[0] and abs(at[1]) <= self.field[1]
                if inside and float(distances(np.array([at]), self.objects).min()) > keep_m:
                    yield (*at, angle + math.pi / 2)
                    yield (*at, angle - math.pi / 2)

    def _leg(self, start: Pose2, goal: Pose2, goal_mps: float) -> float | None:
        """Approximate seconds from start to goal; None if the robot touches something on the way."""
        leg = self.legs.between(start, goal, goal_mps)
        if not self.geometry.gap_m(leg.poses, self.objects) > self.margin_m:  # NaN is not clear
            return None
        return leg.length_m / self.geometry.mean_mps + leg.turned_rad / self.geometry.turn_radps
