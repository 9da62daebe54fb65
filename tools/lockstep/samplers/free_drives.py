"""Drives of the kitchen robot in the open middle of its room, whose ways keep clear of everything by plan."""

from __future__ import annotations

import math

import numpy as np

from tailor.executive.actions.planar import PHI, PHIG, XG, YG, X, Y
from tailor.executive.belief.angles import difference
from tailor.executive.domains.kitchen.drive_to_stand import SEEN, DriveToStand
from tailor.executive.interfaces.values import Array

X_M, Y_M = (-1.75, 1.75), (-1.85, 0.95)  # between the tables; south of the fridge by what the arm reaches
SLACK_M = 0.05  # by which a way may leave that
TABLE3 = (0.85, -1.0)  # nobody drives where x is less and y is lower
NEAR = 0.5  # share of the drives over
NEAR_M = (0.05, 1.5)
FORWARD, FORWARD_RAD = 0.3, 0.5  # share of the goals that are faced about in the direction of driving
POINTS = 40


def free_drive(controller: DriveToStand, rng: np.random.Generator) -> Array:
    """Arguments of a drive from rest to rest, shape (9,); the stool has been seen before every other one."""
    seen = float(rng.integers(2))
    while True:
        x, y, phi = rng.uniform(*X_M), rng.uniform(*Y_M), rng.uniform(-math.pi, math.pi)
        distance, bearing = rng.uniform(*NEAR_M), rng.uniform(-math.pi, math.pi)
        xg, yg = x + distance * math.cos(bearing), y + distance * math.sin(bearing)
        if rng.random() >= NEAR:
            xg, yg = rng.uniform(*X_M), rng.uniform(*Y_M)
        phig = rng.uniform(-math.pi, math.pi)
        if rng.random() < FORWARD:
            phig = math.atan2(yg - y, xg - x) + FORWARD_RAD * rng.standard_normal()
        arguments = np.array([x, y, phi, 0.0, xg, yg, difference(phig, 0.0), 0.0, seen])
        if _is_free(_way(controller, arguments)):
            return arguments


def _way(controller: DriveToStand, arguments: Array) -> Array:
    """Places on the planned way, shape (POINTS, 2)."""
    start, goal = arguments[[X, Y]], arguments[[XG, YG]]
    dx, dy = (start - goal).tolist()
    x, y, phi, xg, yg, phig, seen = arguments[[X, Y, PHI, XG, YG, PHIG, SEEN]].tolist()
    if controller.side((x, y, phi), (xg, yg, phig), bool(seen)) is not None:
        straight: Array = start + np.linspace(0.0, 1.0, POINTS)[:, None] * (goal - start)
        return straight
    c, s = math.cos(phig), math.sin(phig)
    heading = difference(phi, phig)
    path = controller.far.ways.quickest((c * dx + s * dy, c * dy - s * dx, heading), 0.0)
    places = np.array([path.at(at)[:2] for at in np.linspace(0.0, path.length, POINTS)])
    way: Array = goal + places @ np.array([[c, s], [-s, c]])
    return way


def _is_free(way: Array) -> bool:
    x, y = way.T
    inside = (x > X_M[0] - SLACK_M) & (x < X_M[1] + SLACK_M) & (y > Y_M[0] - SLACK_M) & (y < Y_M[1] + SLACK_M)
    at_table = (np.abs(x) < TABLE3[0]) & (y < TABLE3[1])
    return bool((inside & ~at_table).all())
