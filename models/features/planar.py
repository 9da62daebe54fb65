"""Feature spaces of robots that drive on a plane (Table 7): from pose and speed to pose and speed."""

from __future__ import annotations

import numpy as np

from tailor.models.features.features import (
    STEEP,
    FeatureSpace,
    Operations,
    Quantity,
    Rows,
    direction,
    length,
    quantities,
    wrap,
)

POSE = quantities("x:m y:m phi:rad v:m/s xg:m yg:m phig:rad vg:m/s")
TOWARD = quantities("v:m/s v_g:m/s dist:m angle_to:rad angle_at:rad")
PERIODIC = quantities("ahead_at:rad aside_at:rad")  # like the cosine and the sine of angle_at
HALF_PI = np.pi / 2


def _toward(rows: Rows, ops: Operations) -> tuple[Rows, Rows, Rows]:
    """Distance, |angle to the goal| and signed angle at the goal (Table 7).

    The angle at the goal is positive when the robot must turn the same way twice (an S-curve is negative). At zero
    distance the line of sight is the robot's heading, which leaves a turn on the spot. Straight ahead (angle_to = 0)
    counts as a left turn.
    """
    _, dist, turns, left = sighted(rows, ops)
    return dist, ops.absolute(turns[[0]]), turns[[1]] * left


def sighted(rows: Rows, ops: Operations) -> tuple[Rows, Rows, Rows, Rows]:
    """Way to the goal in the map frame, its length, and the angles of both headings from the line of sight.

    The last is 1 where the robot turns left to face the goal, -1 where it turns right.
    """
    away = rows[[4, 5]] - rows[[0, 1]]
    dx, dy = away[[0]], away[[1]]
    dist = length(dx, dy, ops)
    turns = wrap(rows[[2, 6]] - direction(dx, dy, dist, rows[[2]], ops), ops)  # the first is minus that to the goal
    left = ops.clip(turns[[0]] * -STEEP + 1.0, -1.0, 1.0)
    return away, dist, turns, left


def _direct(rows: Rows, ops: Operations) -> Rows:
    return rows


def _relative(rows: Rows, ops: Operations) -> Rows:
    return ops.stack(rows[[4, 5]] - rows[[0, 1]], rows[[2, 3, 6, 7]])


def _projective(rows: Rows, ops: Operations) -> Rows:
    return ops.stack(rows[[3, 7]], *_toward(rows, ops))


def _projective_turn(rows: Rows, ops: Operations) -> Rows:
    turn = ops.absolute(wrap(rows[[6]] - rows[[2]], ops))
    return ops.stack(rows[[3, 7]], *_toward(rows, ops), turn)


def _projective_periodic(rows: Rows, ops: Operations) -> Rows:
    """The angle at the goal also as two triangle waves, which do not jump where it passes half a turn."""
    dist, to, at = _toward(rows, ops)
    aside = ops.absolute(at + HALF_PI) - ops.absolute(at - HALF_PI) - at
    return ops.stack(rows[[3, 7]], dist, to, at, ops.absolute(at), aside)


direct = FeatureSpace("direct", POSE, POSE, _direct)
relative = FeatureSpace("relative", POSE, quantities("dx:m dy:m phi:rad v:m/s phig:rad vg:m/s"), _relative)
projective = FeatureSpace("projective", POSE, TOWARD, _projective)
projective_turn = FeatureSpace("projective-turn", POSE, (*TOWARD, Quantity("turn", "rad")), _projective_turn)
projective_periodic = FeatureSpace("projective-periodic", POSE, (*TOWARD, *PERIODIC), _projective_periodic)
SPACES = (direct, relative, projective, projective_turn, projective_periodic)
