"""Opponents beside the runs of an action, drawn after the run: goToPose and approaches drive as if there were none.

So one run shows, of any number of opponents, which it would have touched. A test compares that with simulated ones.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.simnodes.agilo import dimensions as size

RADII_M = (0.1, 0.3)
NEAR_SHARE = 0.75  # drawn near the way, where it is decided; the others anywhere around it
NEAR_M = 0.8  # from the way to an opponent's side
AROUND_M = 1.5
STEPS = 5  # between two true states, 0.1 s apart: 2 cm at the highest speed
# errors of a believed opponent, at a distance of 0 and for each metre: the camera's after a second, and the pose's
SIGMA_M, SIGMA_PER_M, RADIUS_SIGMA_M = 0.02, 0.015, 0.01
TYPICAL_M = 1.0  # in x and in y: from where one is seen, if nothing more is known
MAX_TRIES = 100
RAIL_HALF_ANGLE, RAIL_M = 1.3265, 0.118 + 0.005  # of its arc around a ball that lies in it


def rail_points() -> Array:
    """Ends of the rail's chords, shape (10, 2): m, robot's frame."""
    angles = np.linspace(-RAIL_HALF_ANGLE, RAIL_HALF_ANGLE, 10)
    centre = size.RAIL_AHEAD_M + RAIL_M - 0.005
    return np.stack([centre - RAIL_M * np.cos(angles), RAIL_M * np.sin(angles)], axis=1)


RAIL = rail_points()
MIDDLE_M = -0.025  # of the chassis, ahead of the axle


def poses_of(truths: Sequence[SoccerGroundTruth]) -> Array:
    """Poses along a run, shape (n, 3), close enough to each other to miss no touch."""
    states = np.array([(t.x, t.y, t.phi) for t in truths])
    states[:, 2] = np.unwrap(states[:, 2])
    at = np.arange(len(states))
    between = np.linspace(0, len(states) - 1, STEPS * (len(states) - 1) + 1)
    return np.stack([np.interp(between, at, column) for column in states.T], axis=1)


def clearances(poses: Array, places: Array) -> Array:
    """Distance of points, shape (m, 2), from the robot's outline at poses (n, 3); shape (m, n), metres."""
    dx, dy = places[:, None, 0] - poses[:, 0], places[:, None, 1] - poses[:, 1]
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    ahead, left = c * dx + s * dy, c * dy - s * dx
    half_length, half_width = size.CHASSIS_LENGTH_M / 2, size.CHASSIS_WIDTH_M / 2
    chassis = np.hypot(
        np.maximum(np.abs(ahead - MIDDLE_M) - half_length, 0.0), np.maximum(np.abs(left) - half_width, 0.0)
    )
    rail = np.min([_to_chord(ahead, left, a, b) for a, b in itertools.pairwise(RAIL)], axis=0) - 0.005
    nearest: Array = np.minimum(chassis, rail)
    return nearest


def draw_beside(poses: Array, rng: np.random.Generator) -> tuple[float, float, float]:
    """Place and radius of an opponent beside a way, clear of its start."""
    for _ in range(MAX_TRIES):
        radius = rng.uniform(*RADII_M)
        reach = radius + (NEAR_M if rng.random() < NEAR_SHARE else AROUND_M)
        at, angle, off = poses[rng.integers(len(poses))], rng.uniform(-math.pi, math.pi), reach * rng.random() ** 0.5
        place = np.array([at[0] + off * math.cos(angle), at[1] + off * math.sin(angle)])
        if clearances(poses[:1], place[None, :])[0, 0] > radius:
            return float(place[0]), float(place[1]), radius
    return float(poses[0, 0]), float(poses[0, 1]) + 3.0, radius


def believed(opponent: tuple[float, float, float], seen_from: Array, rng: np.random.Generator) -> list[float]:
    """Place and radius as they are believed by a robot that has looked for a second from a pose."""
    x, y, radius = opponent
    sigma = SIGMA_M + SIGMA_PER_M * math.hypot(x - seen_from[0], y - seen_from[1])
    off = rng.standard_normal(3)
    return [x + sigma * off[0], y + sigma * off[1], max(0.05, radius + RADIUS_SIGMA_M * off[2])]


def _to_chord(ahead: Array, left: Array, a: Array, b: Array) -> Array:
    dx, dy = b - a
    share = np.clip(((ahead - a[0]) * dx + (left - a[1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
    distance: Array = np.hypot(ahead - a[0] - share * dx, left - a[1] - share * dy)
    return distance
