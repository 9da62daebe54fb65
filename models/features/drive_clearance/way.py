"""The way that a drive to a pose takes as planned: a turn, a straight piece, a bend or a turn into the goal.

It repeats, with the operations of features alone, what `executive/actions/arrival_path.py` plans for far goals; to near
ones the robot turns, drives straight, ahead or backward, and turns. A test compares both with a robot's controller.
Metres and radians.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tailor.models.features.drive_clearance.driving_robot import DrivingRobot
from tailor.models.features.features import TWO_PI, Operations, Rows, direction, length, wrap

RADIUS_M, INSIDE, TIGHTEST_M, RUN_IN_M = 0.45, 0.8, 0.08, 0.10  # see ArrivalPath, of which these are the defaults
BESIDE_M, ASIDE_S_PER_M, FACING_S_PER_RAD, DRIVING_SHARE = 0.12, 20.0, 1 / 1.3, 0.85
NO_BEND = 1e-4  # rad short of a full circle: a bend of zero length with rounding errors
TIE = 1e-6  # between two choices the first one is taken
LARGE = 1e3
SIDES: Any = np.array([[1.0], [-1.0]], np.float32)  # bends to the left and to the right
# of powers of the squared angle, least squares on [-pi, pi]: less than 1e-6 off
COSINE = (-2.19729638e-07, 2.42029414e-05, -0.00138587899, 0.0416597778, -0.499994213, 0.999999211)
SINE = (-2.03622449e-08, 2.69971464e-06, -0.000198086333, 0.00833240299, -0.166665526, 0.9999996)


@dataclass(frozen=True, slots=True)
class Way:
    """A planned way; each field is of shape (1, n).

    Attributes:
      turn: Of the robot at the start, left positive.
      facing: Heading of the straight piece.
      straight: Its length; negative: the robot backs off.
      side: 1: the bend or turn after it is to the left; -1: to the right.
      bend: Angle of that, not negative.
      radius: Of the bend; 0: a turn on the spot.
      run_in: From there straight on to the goal.
    """

    turn: Rows
    facing: Rows
    straight: Rows
    side: Rows
    bend: Rows
    radius: Rows
    run_in: Rows


def cosines(angle: Rows, ops: Operations) -> tuple[Rows, Rows]:
    """Cosines and sines."""
    angle = wrap(angle, ops)
    square = angle * angle
    cosine, sine = square * COSINE[0] + COSINE[1], square * SINE[0] + SINE[1]
    for c, s in zip(COSINE[2:], SINE[2:], strict=True):
        cosine, sine = cosine * square + c, sine * square + s
    return cosine, sine * angle


def is_near(robot: DrivingRobot, poses: Rows, seen: Rows, ops: Operations) -> Rows:
    """Where the robot drives as to a near goal, shape (1, n).

    Args:
      robot: Which robot drives.
      poses: As of `planned`.
      seen: 1 where it has seen what may stand behind it, else 0; shape (1, n).
      ops: Operations of features.
    """
    dist, _, _, turning = _straights(robot, poses, ops)
    near_m = dist * 0.0 + robot.near_m
    back_m = ops.where(seen < 0.5, near_m, near_m * 0.0 + robot.back_m)
    return dist < ops.where(turning[[1]] < robot.back_rad, back_m, near_m)


def planned(robot: DrivingRobot, poses: Rows, goal: tuple[Rows, Rows], near: Rows, ops: Operations) -> Way:
    """The way between poses.

    Args:
      robot: Which robot drives.
      poses: Rows x, y, phi of the start, then of the goal, in any frame; shape (6, n).
      goal: Cosine and sine of the goal's heading.
      near: Where the robot drives as to a near goal, shape (1, n).
      ops: Operations of features.
    """
    return _way(ops.where(near, _straight(robot, poses, ops), _bent(robot, poses, goal, ops)))


def planned_again(
    robot: DrivingRobot, poses: Rows, goal: tuple[Rows, Rows], near: Rows, first: Way, ops: Operations
) -> Way:
    """The way from where the robot has turned to a far goal; to a near one it stays as it was planned first."""
    before = ops.stack(*(getattr(first, name) for name in Way.__slots__))
    return _way(ops.where(near, before, _bent(robot, poses, goal, ops)))


def _way(rows: Rows) -> Way:
    return Way(*(rows[[k]] for k in range(len(Way.__slots__))))


def _straight(robot: DrivingRobot, poses: Rows, ops: Operations) -> Rows:
    """Turn, drive straight, ahead or back, whichever needs less turning, and turn; the fields of a Way, (7, n)."""
    dist, headings, turns, turning = _straights(robot, poses, ops)
    both = ops.stack(turns, headings, dist, dist * -1.0)
    chosen = ops.where(turning[[0]] < turning[[1]] + TIE, both[[0, 2, 4, 6]], both[[1, 3, 5, 7]])
    end, zero = chosen[[1]], dist * 0.0
    side = ops.where(end < 0.0, -1.0, zero + 1.0)
    return ops.stack(chosen[[0, 2, 3]], side, ops.absolute(end), zero, zero)


def _straights(robot: DrivingRobot, poses: Rows, ops: Operations) -> tuple[Rows, Rows, Rows, Rows]:
    """Straight ways ahead and back: length (1, n), headings (2, n), both turns of each (4, n), their sums (2, n)."""
    away = poses[[3, 4]] - poses[[0, 1]]
    dx, dy, phi = away[[0]], away[[1]], poses[[2]]
    dist = length(dx, dy, ops)
    bearing = ops.where(dist < robot.there_m, phi, direction(dx, dy, dist, phi, ops))
    headings = ops.stack(bearing, bearing + np.pi)
    turns = wrap(ops.stack(headings - phi, poses[[5]] - headings), ops)
    turning = ops.absolute(turns)
    return dist, headings, turns, turning[[0, 1]] + turning[[2, 3]]


def _bent(robot: DrivingRobot, poses: Rows, goal: tuple[Rows, Rows], ops: Operations) -> Rows:
    """The quickest: with a bend to the left, to the right, or along the goal's line; the fields of a Way, (7, n)."""
    away, phig, (c, s) = poses[[0, 1]] - poses[[3, 4]], poses[[5]], goal
    dx, dy = away[[0]], away[[1]]
    x, y = c * dx + s * dy, c * dy - s * dx  # of the start, as the goal sees it
    start, zero = wrap(poses[[2]] - phig, ops), x * 0.0
    heading, straight, bend, radius = _into_arc(x + RUN_IN_M, y * SIDES, ops)
    heading = heading * SIDES
    turn = wrap(heading - start, ops)
    driving_s_per_m = 1 / (DRIVING_SHARE * robot.v_max_mps)
    bends_s = ops.absolute(turn) * FACING_S_PER_RAD + (straight + RUN_IN_M) * driving_s_per_m
    bends_s = bends_s + bend * (1 / robot.bend_worth_radps)
    both = ops.stack(turn, heading + phig, straight, zero + SIDES, bend, radius, zero + RUN_IN_M, zero, bends_s)
    left = bends_s[[0]] < bends_s[[1]] + TIE
    arc = ops.where(left, both[[0, 2, 4, 6, 8, 10, 12, 14]], both[[1, 3, 5, 7, 9, 11, 12, 15]])
    aside, dist = ops.absolute(y), x * -1.0
    along_s = ops.absolute(start) * FACING_S_PER_RAD + dist * driving_s_per_m + aside * ASIDE_S_PER_M
    along_s = ops.where(x < 0.0, ops.where(aside < BESIDE_M, along_s, zero + LARGE), zero + LARGE)
    line = ops.stack(start * -1.0, phig, dist, zero + 1.0, zero, zero, zero)
    return ops.where(along_s < arc[[7]], line, arc[[0, 1, 2, 3, 4, 5, 6]])


def _into_arc(x: Rows, aside: Rows, ops: Operations) -> tuple[Rows, Rows, Rows, Rows]:
    """Heading and length of the straight piece, angle and radius of a bend to the left; all of shape (2, n)."""
    outside, square = aside < TIE, x * x
    through_robot = (aside * aside + square) * (0.5 / ops.where(outside, 1.0, aside))
    radius = ops.where(outside, aside * 0.0 + RADIUS_M, ops.clip(through_robot * INSIDE, TIGHTEST_M, RADIUS_M))
    dx, dy = aside * 0.0 - x, radius - aside
    dist = length(dx, dy, ops)
    centre = ops.where(dist < radius, radius, dist)
    straight = ops.sqrt(ops.clip(centre * centre - radius * radius, 0.0, LARGE))
    back = direction(straight, radius, centre, 0.0, ops) - direction(dx, dy, dist, 0.0, ops)
    bend = ops.where(back < 0.0, back + TWO_PI, back)
    return back * -1.0, straight, ops.where(bend < TWO_PI - NO_BEND, bend, bend * 0.0), radius
