"""Draws the opponents of a soccer scenario: many near the straight way, none on start, goal or ball."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tailor.executive.domains.soccer import robot

Point = tuple[float, float]
MAX_TRIES = 10_000  # a declaration that fails so often is contradictory
BESIDE_TRIES = 100  # then there is no room beside the straight way
GAP_M = 0.05  # between two opponents


def sample_opponents(
    declared: Mapping[str, Any],
    start: Mapping[str, float],
    places: Mapping[str, Mapping[str, float]],
    rng: np.random.Generator,
) -> dict[str, float]:
    """Start values of opponents, e.g. opponent1_x, opponent1_radius (m, map frame).

    Args:
      declared: The scenario file: `field` and `opponents`, see scenarios/opponents.toml.
      start: Start of robot and ball.
      places: Places by label.
      rng: Source of every draw.

    Raises:
      ValueError: The ranges are contradictory.
    """
    wanted = declared["opponents"]
    stops, legs = _stops(start, places, wanted["clear_m"]), _legs(start, places)
    drawn: list[tuple[float, float, float]] = []
    fewest, most = wanted["number"]
    for _ in range(int(rng.integers(fewest, most, endpoint=True))):
        near, radius = rng.random() < wanted["near_share"], rng.uniform(*wanted["radius_m"])
        for tries in range(MAX_TRIES):
            beside = near and tries < BESIDE_TRIES
            x, y = _beside(legs[0], wanted["aside_m"], rng) if beside else _anywhere(declared["field"], rng)
            if _stands_clear((x, y), radius, stops, legs[1:], drawn, wanted["clear_m"]):
                break
        else:
            raise ValueError("the ranges of the scenario's opponents are contradictory")
        drawn.append((x, y, radius))
    rows = (zip(("x", "y", "radius"), opponent, strict=True) for opponent in drawn)
    return {f"opponent{n}_{name}": float(value) for n, row in enumerate(rows, 1) for name, value in row}


def _stops(
    start: Mapping[str, float], places: Mapping[str, Mapping[str, float]], clear: Mapping[str, float]
) -> list[tuple[Point, float]]:
    """Points to keep clear, each with the distance to the opponent's side."""
    stops = [((start["x"], start["y"]), clear["start"])]
    stops += [((place["x"], place["y"]), clear["goal"]) for place in places.values() if "x" in place]
    if "ball_x" in start:
        ball = (start["ball_x"], start["ball_y"])
        stops.append((ball, clear["ball"]))
        stops += [
            ((ball[0] - robot.BEHIND_BALL_M * math.cos(p["phi"]), ball[1] - robot.BEHIND_BALL_M * math.sin(p["phi"])),
             clear["goal"])
            for p in places.values() if "x" not in p
        ]  # fmt: skip
    return stops


def _legs(start: Mapping[str, float], places: Mapping[str, Mapping[str, float]]) -> list[tuple[Point, Point]]:
    """Straight ways: to the ball if there is one, then from place to place."""
    points = [(start["x"], start["y"])]
    if "ball_x" in start:
        points.append((start["ball_x"], start["ball_y"]))
    points += [(place["x"], place["y"]) for place in places.values() if "x" in place]
    return list(itertools.pairwise(points))


def _beside(leg: tuple[Point, Point], aside_m: float, rng: np.random.Generator) -> Point:
    (ax, ay), (bx, by) = leg
    length = math.dist(*leg)
    along, aside = rng.uniform(0.1, 0.9), rng.uniform(-aside_m, aside_m)
    return ax + along * (bx - ax) - aside * (by - ay) / length, ay + along * (by - ay) + aside * (bx - ax) / length


def _anywhere(field: Mapping[str, Any], rng: np.random.Generator) -> Point:
    return rng.uniform(*field["x_m"]), rng.uniform(*field["y_m"])


def _stands_clear(
    at: Point,
    radius: float,
    stops: Sequence[tuple[Point, float]],
    later_legs: Sequence[tuple[Point, Point]],
    others: Sequence[tuple[float, float, float]],
    clear: Mapping[str, float],
) -> bool:
    return (
        all(math.dist(at, point) >= radius + distance for point, distance in stops)
        and all(_to_segment(at, *leg) >= radius + clear["later_ways"] for leg in later_legs)
        and all(math.dist(at, (x, y)) >= radius + other + GAP_M for x, y, other in others)
    )


def _to_segment(p: Point, a: Point, b: Point) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    share = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)
    share = min(1.0, max(0.0, share))
    return math.dist(p, (a[0] + share * dx, a[1] + share * dy))
