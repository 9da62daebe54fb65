"""Ways around discs as an engineer computes them: a graph of poses beside the discs, joined by arcs that stay clear.

Edges are the ways which goToPose drives. Two poses between start and goal are enough for the scenarios.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.actions.dubins import Pose2
from tailor.executive.belief.angles import difference
from tailor.executive.interfaces.values import Array

Disc = tuple[float, float, float]  # x, y, radius in m
# from the path to a disc's edge: half the robot's width, its rail in bends, noise; less where there is no other way
CLEARANCES_M = (0.30, 0.25, 0.20)
BESIDE_M = 0.42  # from a disc's edge to the poses around it
AROUND = 10  # poses around a disc, in both directions each
PASSING_MPS = 0.5
SAMPLE_M = 0.08  # along a path
MEAN_MPS, TURN_RADPS = 0.6, 1.4  # for the time of a way

Way = tuple[float, tuple[Pose2, ...]]  # seconds, poses between start and goal


@dataclass(frozen=True, slots=True)
class DetourGraph:
    """Poses around discs, and the ways between them.

    Attributes:
      ways: Paths of the controller that drives.
      discs: What is in the way.
      field: Half the length and half the width of where poses may lie, m.
      clear_m: Distance that a path keeps from a disc's edge.
    """

    ways: ArrivalPath
    discs: tuple[Disc, ...]
    field: tuple[float, float]
    clear_m: float = CLEARANCES_M[0]

    def shortest(self, start: Pose2, goal: Pose2, goal_mps: float) -> tuple[Pose2, ...] | None:
        """Poses on the quickest way that stays clear; empty if the direct way does, None if there is no such way."""
        if self._leg(start, goal, goal_mps) is not None:
            return ()
        poses = list(self._poses())
        begun = [(s, p) for p in poses if (s := self._leg(start, p, PASSING_MPS)) is not None]
        ended = [(s, p) for p in poses if (s := self._leg(p, goal, goal_mps)) is not None]
        after = {pose: seconds for seconds, pose in ended}
        single = [(s + after[p], (p,)) for s, p in begun if p in after]
        best: Way = min(single, default=(math.inf, ()))
        seconds, chosen = self._with_two(begun, ended, best)
        return chosen if seconds < math.inf else None

    def clear(self, start: Pose2, goal: Pose2, goal_mps: float) -> bool:
        """Whether the way from start to goal stays clear of all discs."""
        return self._leg(start, goal, goal_mps) is not None

    def _with_two(self, begun: Sequence[tuple[float, Pose2]], ended: Sequence[tuple[float, Pose2]], best: Way) -> Way:
        """The best way over two poses, if it is better; bounded below by the straight distance."""
        pairs = sorted((s + math.dist(p[:2], q[:2]) / MEAN_MPS + t, p, q, s + t) for s, p in begun for t, q in ended)
        for bound, p, q, known in pairs:
            if bound >= best[0]:
                break
            middle = self._leg(p, q, PASSING_MPS)
            if middle is not None and known + middle < best[0]:
                best = known + middle, (p, q)
        return best

    def _poses(self) -> Iterator[Pose2]:
        for x, y, radius in self.discs:
            for k in range(AROUND):
                angle = math.tau * k / AROUND
                at = x + (radius + BESIDE_M) * math.cos(angle), y + (radius + BESIDE_M) * math.sin(angle)
                inside = abs(at[0]) <= self.field[0] and abs(at[1]) <= self.field[1]
                if inside and all(math.dist(at, (ox, oy)) > r + self.clear_m for ox, oy, r in self.discs):
                    yield (*at, angle + math.pi / 2)
                    yield (*at, angle - math.pi / 2)

    def _leg(self, start: Pose2, goal: Pose2, goal_mps: float) -> float | None:
        """Approximate seconds from start to goal; None if the path touches what is in the way."""
        x, y, phi = goal
        c, s = math.cos(phi), math.sin(phi)
        dx, dy = start[0] - x, start[1] - y
        seen = (c * dx + s * dy, c * dy - s * dx, difference(start[2], phi))
        path = self.ways.quickest(seen, goal_mps)
        count = max(2, math.ceil(path.length / SAMPLE_M) + 1)
        points = np.array([path.at(path.length * k / (count - 1))[:2] for k in range(count)])
        if not self._is_clear(x + c * points[:, 0] - s * points[:, 1], y + s * points[:, 0] + c * points[:, 1]):
            return None
        return path.length / MEAN_MPS + abs(difference(path.start[2], seen[2])) / TURN_RADPS

    def _is_clear(self, x: Array, y: Array) -> bool:
        return all(float(np.hypot(x - ox, y - oy).min()) > radius + self.clear_m for ox, oy, radius in self.discs)
