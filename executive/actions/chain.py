"""Kinematics of a serial arm from a table of its joints: where the hand is, and which angles bring it somewhere.

Inverse kinematics by damped least squares (Wampler, IEEE Trans. SMC 16, 1986) over the joints of the arm alone. Scalar
arithmetic in a fixed order: a solution is the same on every CPU.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from tailor.executive.actions.cubic import Joints

Vector = tuple[float, float, float]
Turn = tuple[Vector, Vector, Vector]  # a rotation: its columns, the turned x, y and z axes

UPRIGHT: Turn = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True, slots=True)
class ChainJoint:
    """A revolute joint: its place in the frame of the joint before it, its unit axis, and its range."""

    place: Vector  # m
    axis: Vector
    lower: float  # rad
    upper: float


@dataclass(frozen=True, slots=True)
class HandPose:
    """Pose of the hand in the frame of the arm's base; the hand's x axis points out of it."""

    place: Vector  # m
    turn: Turn


@dataclass(frozen=True, slots=True)
class Chain:
    """A serial arm: its joints from the base on, and the place of the hand behind the last one.

    `solve` moves each step by at most `step_rad`, damped by `damping`; an error of 1 rad weighs as one of `arm_m`.
    """

    joints: tuple[ChainJoint, ...]
    hand: Vector
    damping: float = 0.02
    step_rad: float = 0.35
    arm_m: float = 0.3
    steps: int = 60
    reached_m: float = 0.002
    reached_rad: float = 0.01

    def forward(self, angles: Joints) -> HandPose:
        """Pose of the hand for joint angles (rad)."""
        return self._frames(angles)[0]

    def solve(self, goal: HandPose, seed: Joints) -> Joints | None:
        """Joint angles within their ranges that bring the hand to a pose; None if none are found from the seed."""
        angles = self.within(seed)
        for _ in range(self.steps):
            pose, axes, places = self._frames(angles)
            off, turned = _minus(goal.place, pose.place), rotation_error(pose.turn, goal.turn)
            if math.hypot(*off) < self.reached_m and math.hypot(*turned) < self.reached_rad:
                return angles if _is_within_a_right_angle(pose.turn, goal.turn) else None
            columns = [
                (*_cross(axis, _minus(pose.place, place)), *_scaled(axis, self.arm_m))
                for axis, place in zip(axes, places, strict=True)
            ]
            change = _least_squares(columns, (*off, *_scaled(turned, self.arm_m)), self.damping)
            longest = max(self.step_rad, *map(abs, change))
            scale = self.step_rad / longest
            angles = self.within(tuple(angle + scale * by for angle, by in zip(angles, change, strict=True)))
        return None

    def within(self, angles: Joints) -> Joints:
        """Angles clipped to the ranges of the joints."""
        return tuple(max(j.lower, min(j.upper, angle)) for j, angle in zip(self.joints, angles, strict=True))

    def _frames(self, angles: Joints) -> tuple[HandPose, list[Vector], list[Vector]]:
        """Pose of the hand, and the axis and place of each joint."""
        place, turn = (0.0, 0.0, 0.0), UPRIGHT
        axes, places = [], []
        for joint, angle in zip(self.joints, angles, strict=True):
            place = _plus(place, _turned(turn, joint.place))
            axes.append(_turned(turn, joint.axis))
            places.append(place)
            turn = _composed(turn, about(joint.axis, angle))
        return HandPose(_plus(place, _turned(turn, self.hand)), turn), axes, places


def about(axis: Vector, angle: float) -> Turn:
    """Rotation about a unit axis (Rodrigues)."""
    (x, y, z), c, s = axis, math.cos(angle), math.sin(angle)
    t = 1.0 - c
    return (
        (t * x * x + c, t * x * y + s * z, t * x * z - s * y),
        (t * x * y - s * z, t * y * y + c, t * y * z + s * x),
        (t * x * z + s * y, t * y * z - s * x, t * z * z + c),
    )


def rotation_error(now: Turn, goal: Turn) -> Vector:
    """Rotation vector (rad, sine of the angle) that turns one orientation towards another."""
    total = (0.0, 0.0, 0.0)
    for axis, wanted in zip(now, goal, strict=True):
        total = _plus(total, _scaled(_cross(axis, wanted), 0.5))
    return total


def _is_within_a_right_angle(now: Turn, goal: Turn) -> bool:
    """Whether less than a right angle is between two orientations: the sine, half a circle off, is zero as well."""
    trace = sum(a * b for axis, wanted in zip(now, goal, strict=True) for a, b in zip(axis, wanted, strict=True))
    return trace > 1.0  # 1 + 2 cos(angle)


def _least_squares(columns: Sequence[tuple[float, ...]], error: Sequence[float], damping: float) -> Joints:
    """Jᵀ(JJᵀ + λ²I)⁻¹e for the columns of J."""
    n = len(error)
    rows = [[sum(c[i] * c[j] for c in columns) + (damping**2 if i == j else 0.0) for j in range(n)] for i in range(n)]
    solved = _solved([[*row, e] for row, e in zip(rows, error, strict=True)])
    return tuple(sum(a * b for a, b in zip(column, solved, strict=True)) for column in columns)


def _solved(rows: list[list[float]]) -> list[float]:
    """Solution of a symmetric, positive definite system with its right side as last column: needs no pivots."""
    n = len(rows)
    for i in range(n):
        for row in rows[i + 1 :]:
            factor = row[i] / rows[i][i]
            for j in range(i, n + 1):
                row[j] -= factor * rows[i][j]
    solution = [0.0] * n
    for i in range(n - 1, -1, -1):
        known = sum(rows[i][j] * solution[j] for j in range(i + 1, n))
        solution[i] = (rows[i][n] - known) / rows[i][i]
    return solution


def _composed(a: Turn, b: Turn) -> Turn:
    return _turned(a, b[0]), _turned(a, b[1]), _turned(a, b[2])


def _turned(turn: Turn, v: Vector) -> Vector:
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = turn
    x, y, z = v
    return ax * x + bx * y + cx * z, ay * x + by * y + cy * z, az * x + bz * y + cz * z


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _plus(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _scaled(a: Vector, by: float) -> Vector:
    return a[0] * by, a[1] * by, a[2] * by
