"""A kinematic stand-in for goToPose: episodes for tests of learning, without a robot."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
TICK_S = 0.1


def wrap(angle: float) -> float:
    return (angle + math.pi) % (2 * math.pi) - math.pi


def draw(rng: np.random.Generator) -> Array:
    lower = np.array([-3.5, -2.25, -np.pi, 0.0] * 2)
    upper = np.array([3.5, 2.25, np.pi, 0.75, 3.5, 2.25, np.pi, 0.6])
    return rng.uniform(lower, upper)


def run(arguments: Array, rng: np.random.Generator) -> tuple[Array, float, bool]:
    """Ticks (t, 8), duration in seconds, and whether a ball at the goal stayed untouched."""
    x, y, phi, v, xg, yg, phig, vg = arguments.tolist()  # floats: numpy takes five times as long for single numbers
    omega, ticks, touched = 0.0, [], False
    ball_x, ball_y = xg + 0.35 * math.cos(phig), yg + 0.35 * math.sin(phig)
    for tick in range(400):
        noise = rng.normal(0, 0.01, 3).tolist()
        ticks.append([x + noise[0], y + noise[1], phi + noise[2], v, xg, yg, phig, vg])
        d = math.hypot(xg - x, yg - y)
        if d < 0.12 and abs(wrap(phig - phi)) < 0.2:
            return np.array(ticks), tick * TICK_S, not touched
        touched = touched or math.hypot(ball_x - x, ball_y - y) < 0.27
        aim = (xg - 0.25 * d * math.cos(phig), yg - 0.25 * d * math.sin(phig))
        error = wrap(phig - phi) if d < 0.12 else wrap(math.atan2(aim[1] - y, aim[0] - x) - phi)
        omega += limited(limited(2.8 * error, -1.75, 1.75) - omega, -0.175, 0.175)
        want = 0.0 if d < 0.12 else 0.9 * max(math.cos(error), 0.0) ** 1.5
        want = min(want, math.sqrt(vg**2 + 1.1 * max(d - 0.1, 0.0)) + 0.05)
        v += limited(want - v, -0.065, 0.05)
        x, y, phi = x + v * math.cos(phi) * TICK_S, y + v * math.sin(phi) * TICK_S, phi + omega * TICK_S
    return np.array(ticks), 400 * TICK_S, not touched


def limited(value: float, lower: float, upper: float) -> float:
    return min(max(value, lower), upper)


def episodes(count: int, seed: int) -> list[tuple[Array, float, bool]]:
    made = []
    for k in range(count):
        rng = np.random.default_rng([seed, k])
        made.append(run(draw(rng), rng))
    return made


def examples(made: list[tuple[Array, float, bool]], n_i: int) -> tuple[Array, Array, NDArray[np.int64]]:
    """Arguments (n, 8), remaining seconds (n,) and episode numbers (n,) of the first n_i ticks."""
    rows = [ticks[:n_i] for ticks, _, _ in made]
    rest = [duration - TICK_S * np.arange(len(r)) for (_, duration, _), r in zip(made, rows, strict=True)]
    groups = np.repeat(np.arange(len(made)), [len(r) for r in rows])
    return np.concatenate(rows), np.concatenate(rest), groups
