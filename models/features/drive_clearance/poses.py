"""Poses on a planned drive: while the robot turns to its way, on the straight piece, in the bend into its goal.

A robot that begins in motion rolls on as it brakes to turn. One that turns to a far goal drives on as soon as it faces
its way roughly, so it leaves the place where it turns.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tailor.models.features.drive_clearance.driving_robot import Drift, DrivingRobot
from tailor.models.features.drive_clearance.way import Way, cosines, is_near, planned, planned_again
from tailor.models.features.features import TWO_PI, Operations, Rows

POSES = 8  # of each part of a drive
TURNED: Any = np.linspace(0.0, 1.0, POSES, dtype=np.float32)[:, None]  # share of a turn or a bend
LEFT: Any = 1 - TURNED
EITHER_RAD = 2.7  # of a larger turn, noise and the next plan decide the side
DRIVEN: Any = (np.arange(1, POSES + 1, dtype=np.float32) / POSES)[:, None]  # share of the straight piece
FIRST, SECOND = list(range(POSES)), list(range(POSES, 2 * POSES))


@dataclass(frozen=True, slots=True)
class Poses:
    """Places and directions ahead, each of shape (k, n)."""

    x: Rows
    y: Rows
    ahead_x: Rows
    ahead_y: Rows

    def ahead(self, distance_m: float) -> tuple[Rows, Rows]:
        """Places that are so far ahead of the robot's middle."""
        return self.x + self.ahead_x * distance_m, self.y + self.ahead_y * distance_m


@dataclass(frozen=True, slots=True)
class Drive:
    """A drive as planned.

    Attributes:
      first: As planned at the start, before the turn.
      way: As planned when the robot has turned; equal to `first` for near goals.
      turning: As the robot turns to its way.
      other: As it turns to the other side, where about half a circle may be turned to either; else as `turning`.
      straight: On the straight piece, x and y of shape (POSES, n).
      arriving: In the bend, or the turn on the spot, into the goal.
    """

    first: Way
    way: Way
    turning: Poses
    other: Poses
    straight: tuple[Rows, Rows]
    arriving: Poses


def drive(robot: DrivingRobot, poses: Rows, v: Rows, goal: tuple[Rows, Rows], seen: Rows, ops: Operations) -> Drive:
    """The drive between poses.

    Args:
      robot: Which robot drives.
      poses: Rows x, y, phi of the start, then of the goal, in any frame; shape (6, n).
      v: Speed at the start, shape (1, n); negative: it rolls back.
      goal: Cosine and sine of the goal's heading.
      seen: As of `is_near`.
      ops: Operations of features.
    """
    near = is_near(robot, poses, seen, ops)
    poses = _rolled(robot, poses, v, ops)
    first = planned(robot, poses, goal, near, ops)
    turning = _turning(robot.drift, poses, first.turn, near, ops)
    last = [POSES - 1]
    turned = ops.stack(turning.x[last], turning.y[last], first.facing, poses[[3, 4, 5]])
    way = planned_again(robot, turned, goal, near, first, ops)
    arriving = _arriving(poses, way, goal, ops)
    x, y = arriving.ahead_x[[0]], arriving.ahead_y[[0]]
    straight = turned[[0]] + x * way.straight * DRIVEN, turned[[1]] + y * way.straight * DRIVEN
    back = ops.where(first.turn < 0.0, first.turn + TWO_PI, first.turn - TWO_PI)
    other = ops.where(ops.absolute(first.turn) < EITHER_RAD, first.turn, back)
    return Drive(first, way, turning, _turning(robot.drift, poses, other, near, ops), straight, arriving)


def _rolled(robot: DrivingRobot, poses: Rows, v: Rows, ops: Operations) -> Rows:
    """The poses with the start where the robot rolls on to before it turns."""
    c, s = cosines(poses[[2]], ops)
    rolled_m = v * ops.absolute(v) * (0.5 / robot.braking_mps2)
    return ops.stack(poses[[0]] + c * rolled_m, poses[[1]] + s * rolled_m, poses[[2, 3, 4, 5]])


def _turning(drift: Drift, poses: Rows, turn: Rows, near: Rows, ops: Operations) -> Poses:
    """The turn to the way; with less than a right angle left the robot drives, faster and faster."""
    angle, zero = ops.absolute(turn), turn * 0.0
    total = ops.clip(angle, 0.0, np.pi / 2)
    left = angle * LEFT
    left = ops.where(left < total, left, total)
    driven = left * -1.0 + total
    cosine, sine = cosines(ops.stack(left, poses[[2]] + turn * TURNED), ops)
    c, s, ahead_x, ahead_y = cosine[FIRST], sine[FIRST], cosine[SECOND], sine[SECOND]
    growth = ops.clip((angle * -1.0 + drift.from_rad) * drift.slope, drift.least, drift.most)
    growth = ops.where(near, zero, growth)
    along, aside = (c - c[[0]] - driven * s) * growth, (driven * c + s - s[[0]]) * growth
    aside = aside * ops.where(turn < 0.0, 1.0, zero - 1.0)
    to_x, to_y = ahead_x[[POSES - 1]], ahead_y[[POSES - 1]]
    x, y = poses[[0]] + to_x * along - to_y * aside, poses[[1]] + to_y * along + to_x * aside
    return Poses(x, y, ahead_x, ahead_y)


def _arriving(poses: Rows, way: Way, goal: tuple[Rows, Rows], ops: Operations) -> Poses:
    """The bend or turn into the goal, up to its run-in."""
    c, s = cosines(way.facing + way.side * way.bend * TURNED, ops)
    lever = way.radius * way.side
    x = poses[[3]] - goal[0] * way.run_in + (s - goal[1]) * lever
    y = poses[[4]] - goal[1] * way.run_in - (c - goal[0]) * lever
    return Poses(x, y, c, s)
