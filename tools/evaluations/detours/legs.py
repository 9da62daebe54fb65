"""Ways of controllers between two poses: turned to on the spot, then driven, bent into the goal or straight."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tailor.executive.actions.arrival_path import ArrivalPath
from tailor.executive.actions.dubins import Pose2
from tailor.executive.actions.go_to_pose import GoToPose
from tailor.executive.belief.angles import difference
from tailor.executive.interfaces.values import Array

SAMPLE_M, SAMPLE_RAD = 0.08, 0.1
Straight = Callable[[Pose2, Pose2], float | None]  # heading of the robot on a straight way; None: it bends


@dataclass(frozen=True, slots=True)
class Leg:
    """A way from pose to pose.

    Attributes:
      poses: On it, shape (n, 3).
      length_m: Of what is driven.
      turned_rad: On the spot.
    """

    poses: Array
    length_m: float
    turned_rad: float


@dataclass(frozen=True, slots=True)
class Legs:
    """Ways as a controller plans them.

    Attributes:
      ways: Paths into goals.
      straight: Where it drives straight instead.
    """

    ways: ArrivalPath
    straight: Straight

    def between(self, start: Pose2, goal: Pose2, goal_mps: float) -> Leg:
        """The way into a goal that is passed with `goal_mps`."""
        heading = self.straight(start, goal)
        return self._bent(start, goal, goal_mps) if heading is None else _straight(start, goal, heading)

    def _bent(self, start: Pose2, goal: Pose2, goal_mps: float) -> Leg:
        x, y, phi = goal
        c, s = math.cos(phi), math.sin(phi)
        dx, dy = start[0] - x, start[1] - y
        seen = (c * dx + s * dy, c * dy - s * dx, difference(start[2], phi))
        path = self.ways.quickest(seen, goal_mps)
        at = np.array([path.at(each)[:3] for each in _steps(path.length, SAMPLE_M)])
        driven = np.stack([x + c * at[:, 0] - s * at[:, 1], y + s * at[:, 0] + c * at[:, 1], phi + at[:, 2]], axis=1)
        turn = difference(path.start[2], seen[2])
        return Leg(np.concatenate([_turned(start, turn), driven]), path.length, abs(turn))


def _straight(start: Pose2, goal: Pose2, heading: float) -> Leg:
    turn, last = difference(heading, start[2]), difference(goal[2], heading)
    length = math.dist(start[:2], goal[:2])
    places = np.linspace(start[:2], goal[:2], len(_steps(length, SAMPLE_M)))
    driven = np.column_stack([places, np.full(len(places), heading)])
    poses = np.concatenate([_turned(start, turn), driven, _turned((goal[0], goal[1], heading), last)])
    return Leg(poses, length, abs(turn) + abs(last))


def _turned(pose: Pose2, turn: float) -> Array:
    """Poses as the robot turns on the spot, shape (n, 3)."""
    x, y, phi = pose
    return np.array([(x, y, phi + math.copysign(each, turn)) for each in _steps(abs(turn), SAMPLE_RAD)])


def _steps(total: float, most: float) -> Array:
    """From 0 to the total, at least two, none farther apart than `most`."""
    steps: Array = np.linspace(0.0, total, max(2, math.ceil(total / most) + 1))
    return steps


def legs_of(controller: Any, seen: bool) -> Legs:
    """The ways of a goToPose, or of one that drives straight to some goals.

    Args:
      controller: Such a one, as `DriveToStand`.
      seen: Whether it has seen what may stand behind it, if that makes a difference to it.
    """
    if isinstance(controller, GoToPose):
        return Legs(controller.ways, lambda start, goal: None)

    def straight(start: Pose2, goal: Pose2) -> float | None:
        side = controller.side(start, goal, seen)
        bearing = math.atan2(goal[1] - start[1], goal[0] - start[0])
        return None if side is None else bearing if side > 0 else bearing + math.pi

    return Legs(controller.far.ways, straight)
