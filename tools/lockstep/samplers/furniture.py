"""Objects beside the drives of the kitchen robot, drawn after the drive: goToPose drives as if there were none."""

from __future__ import annotations

import math

import numpy as np

from tailor.executive.domains.kitchen.drive_context import STOOL_RADII_M, TOUCHED, TURN_RAD
from tailor.executive.interfaces.values import Array
from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M
from tailor.tools.lockstep.samplers.beside import Beside
from tailor.tools.lockstep.samplers.outlines import OUTREACH_M, clearances

STOOLS, LOW_BOXES = 0.25, 0.5  # shares of the objects up to here; the others are tall boxes
LOW_M, TALL_M = ((0.2, 3.2), (0.05, 0.55)), ((0.2, 0.5), (0.2, 0.5))  # half length and half width
HEIGHTS_M = (0.72, 1.8)  # of low boxes, as tables, and of tall ones
ROOM_M = (-0.05, 0.6)  # from the base to the object, uniformly, at the pose beside which it is drawn
AT_END, AT_LAST = 0.5, 0.6  # share of the objects beside an end of the drive, and of these beside its goal
CORNERS = 0.35  # share of the boxes that have a corner nearest to that pose
SIGMA_M = 0.01  # of a believed object
TOO_NEAR_M = 0.02  # what a drive passes nearer counts as touched: another one may pass it as much nearer
MAX_TRIES = 200
STEPS = 4  # between two true states, 0.1 s apart: 1.5 cm at the highest speed


def beside(way: Array, tick: int, rng: np.random.Generator) -> Beside:
    """An object near a drive that is clear of its start; and whether the robot, its arm folded, comes too near.

    Args:
      way: Poses of the robot from `tick` of a run on, shape (n, 3), m and rad.
      tick: That tick.
      rng: Source of every draw.
    """
    dense = _dense(way)
    for _ in range(MAX_TRIES):
        row = _object(dense, rng)
        clear_m = clearances(dense, row)
        if clear_m[0] > TOO_NEAR_M:
            break
    else:
        row = np.array([way[0, 0], way[0, 1] + 2.0, 0.0, 0.0, 0.0, STOOL_RADII_M[1], kitchen().stool.height])
        clear_m = clearances(dense, row)
    failure = TOUCHED if clear_m.min() < TOO_NEAR_M else ""
    row[:2] += SIGMA_M * rng.standard_normal(2)
    return Beside(tick, row, failure)


def _dense(way: Array) -> Array:
    """The poses with further ones between them."""
    between = np.linspace(0, len(way) - 1, STEPS * (len(way) - 1) + 1)
    columns = (*way[:, :2].T, np.unwrap(way[:, 2]))
    return np.stack([np.interp(between, np.arange(len(way)), column) for column in columns], axis=1)


def _object(way: Array, rng: np.random.Generator) -> Array:
    """A row of the context: a stool, a low or a tall box beside a pose of the drive, half of them beside an end."""
    at = way[-1 if rng.random() < AT_LAST else 0] if rng.random() < AT_END else way[rng.integers(len(way))]
    kind, phi = rng.random(), rng.uniform(TURN_RAD, TURN_RAD + math.pi)
    away = BASE_RADIUS_M + rng.uniform(*ROOM_M)
    if kind < STOOLS:
        radius, angle = rng.uniform(*STOOL_RADII_M), rng.uniform(-math.pi, math.pi)
        x, y = at[0] + (away + radius) * math.cos(angle), at[1] + (away + radius) * math.sin(angle)
        return np.array([x, y, phi, 0.0, 0.0, radius, kitchen().stool.height])
    tall = kind >= LOW_BOXES
    long, wide = (rng.uniform(*ends) for ends in (TALL_M if tall else LOW_M))
    across = _nearest_point(long, wide, away + OUTREACH_M * tall, rng)
    c, s = math.cos(phi), math.sin(phi)
    x, y = at[0] - (c * across[0] - s * across[1]), at[1] - (s * across[0] + c * across[1])
    return np.array([x, y, phi, long, wide, 0.0, HEIGHTS_M[int(tall)]])


def _nearest_point(long: float, wide: float, away: float, rng: np.random.Generator) -> tuple[float, float]:
    """A place so far from the outline of a box, in its frame: beside a corner, or beside a side."""
    angle, point = rng.uniform(0.0, math.pi / 2), (long, wide)
    if rng.random() >= CORNERS:
        beside_length = rng.uniform(0.0, long + wide) < long
        angle = math.pi / 2 if beside_length else 0.0
        point = (rng.uniform(-long, long), wide) if beside_length else (long, rng.uniform(-wide, wide))
    left, below = rng.choice([-1.0, 1.0], 2)
    return left * (point[0] + away * math.cos(angle)), below * (point[1] + away * math.sin(angle))
