"""Stools beside the drives of the kitchen robot, drawn after the drive: goToPose drives as if there were none."""

from __future__ import annotations

import math

import numpy as np

from tailor.executive.domains.kitchen.action_library import STOOL_RADII_M, TOUCHED_STOOL
from tailor.executive.interfaces.values import Array
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M
from tailor.tools.lockstep.samplers.beside import Beside

NEAR_M = 0.6  # from the robot's side to the stool's, uniformly over distances
SIGMA_M = 0.01  # of a believed stool
MAX_TRIES = 100
STEPS = 4  # between two true states, 0.1 s apart: 1.5 cm at the highest speed


def beside(way: Array, tick: int, rng: np.random.Generator) -> Beside:
    """A stool near a way, shape (n, 2), that is clear of its start; and whether the base touches it.

    Args:
      way: Places of the robot's middle from `tick` of a run on, m.
      tick: That tick.
      rng: Source of every draw.
    """
    between = np.linspace(0, len(way) - 1, STEPS * (len(way) - 1) + 1)
    dense = np.stack([np.interp(between, np.arange(len(way)), column) for column in way.T], axis=1)
    for _ in range(MAX_TRIES):
        radius = rng.uniform(*STOOL_RADII_M)
        at, angle = way[rng.integers(len(way))], rng.uniform(-math.pi, math.pi)
        off = rng.uniform(0.0, radius + BASE_RADIUS_M + NEAR_M)
        place = at + off * np.array([math.cos(angle), math.sin(angle)])
        if np.hypot(*(place - way[0])) > radius + BASE_RADIUS_M + SIGMA_M:
            break
    else:
        place = way[0] + np.array([0.0, 2.0])
    touched = np.hypot(*(dense - place).T).min() < radius + BASE_RADIUS_M
    row = np.array([*(place + SIGMA_M * rng.standard_normal(2)), radius])
    return Beside(tick, row, TOUCHED_STOOL if touched else "")
