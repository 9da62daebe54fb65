"""Draws a soccer scenario: places of robot, balls, target, waypoints and opponents, and events that move the ball."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from tailor.executive.belief.angles import wrap
from tailor.executive.domains.soccer.opponent_sampling import sample_opponents

Point = tuple[float, float]
MAX_TRIES = 10_000  # a declaration that fails so often is contradictory
SECOND_TRIES = 200  # for a second ball, before the first one is drawn anew: in a corner there may be no room for two


def sample_scenario(
    declared: Mapping[str, Any], rng: np.random.Generator
) -> tuple[dict[str, float], dict[str, dict[str, float]], tuple[dict[str, float], ...]]:
    """Draw start state, places by label and events uniformly from the ranges of a scenario file.

    Args:
      declared: The scenario file: see scenarios/*.toml, which explain their own keys.
      rng: Source of every draw.

    Returns:
      Start state of robot, balls and opponents, places by label, and events; metres, radians, m/s, seconds, map frame.

    Raises:
      ValueError: The ranges are contradictory.
    """
    if "waypoints" in declared:
        start, places = _waypoints(declared, rng)
    elif "arrival" in declared:
        start, places = _ball_alone(declared, rng)
    elif "ball2_label" in declared["settings"]:
        start, places = _two_balls_and_target(declared, rng)
    else:
        start, places = _ball_and_target(declared, rng)
    events = tuple(_event(row, start, places, rng) for row in declared.get("events", ()))
    if "opponents" in declared:
        start = {**start, **sample_opponents(declared, start, places, rng)}
    return start, places, events


def _ball_and_target(
    declared: Mapping[str, Any], rng: np.random.Generator
) -> tuple[dict[str, float], dict[str, dict[str, float]]]:
    field, apart = declared["field"], declared["apart"]
    for _ in range(MAX_TRIES):
        robot, ball, target = _point(field, rng), _point(field, rng), _point(field, rng)
        near_enough = _within(robot, ball, apart["robot_ball_m"]) and _within(ball, target, apart["ball_target_m"])
        if near_enough and math.dist(robot, target) > apart["robot_target_min_m"] and _bent(robot, ball, target, apart):
            break
    else:
        raise ValueError("the ranges of the scenario are contradictory")
    start = _looking(robot, ball, declared["robot"]["half_view_rad"], rng)
    aside = declared["target"]["aside_rad"]
    phi = _bearing(ball, target) + rng.uniform(-aside, aside)
    label = declared["settings"]["target_label"]
    return start, {label: {"x": target[0], "y": target[1], "phi": wrap(phi), "v": 0.0}}


def _two_balls_and_target(
    declared: Mapping[str, Any], rng: np.random.Generator
) -> tuple[dict[str, float], dict[str, dict[str, float]]]:
    """Two balls in view, and the target of either, whose heading suits both."""
    for _ in range(MAX_TRIES):
        start, places = _ball_and_target(declared, rng)
        (target,) = places.values()
        second = _second_ball(declared, start, target, rng)
        if second is not None:
            return {**start, "ball2_x": second[0], "ball2_y": second[1]}, places
    raise ValueError("the ranges of the scenario are contradictory")


def _second_ball(
    declared: Mapping[str, Any], start: Mapping[str, float], target: Mapping[str, float], rng: np.random.Generator
) -> Point | None:
    """A ball that the robot sees and could dribble to the target; None where hardly any place beside the first is."""
    apart, half_view, aside = declared["apart"], declared["robot"]["half_view_rad"], declared["target"]["aside_rad"]
    robot, first, goal = (start["x"], start["y"]), (start["ball_x"], start["ball_y"]), (target["x"], target["y"])
    for _ in range(SECOND_TRIES):
        ball = _point(declared["field"], rng)
        if (
            _within(robot, ball, apart["robot_ball_m"])
            and _within(ball, goal, apart["ball_target_m"])
            and math.dist(first, ball) >= apart["balls_min_m"]
            and abs(wrap(_bearing(robot, ball) - start["phi"])) <= half_view
            and abs(wrap(target["phi"] - _bearing(ball, goal))) <= aside
        ):
            return ball
    return None


def _ball_alone(
    declared: Mapping[str, Any], rng: np.random.Generator
) -> tuple[dict[str, float], dict[str, dict[str, float]]]:
    """A ball to approach; heading and speed at the ball are required."""
    field, arrival = declared["field"], declared["arrival"]
    robot = ball = _point(field, rng)
    while not _within(robot, ball, declared["apart"]["robot_ball_m"]):
        ball = _point(field, rng)
    start = _looking(robot, ball, declared["robot"]["half_view_rad"], rng)
    required = {"phi": rng.uniform(*arrival["phi_rad"]), "v": rng.uniform(*arrival["v_mps"])}
    return start, {declared["settings"]["ball_label"]: required}


def _looking(robot: Point, ball: Point, half_view: float, rng: np.random.Generator) -> dict[str, float]:
    """A start at rest with the ball in view."""
    heading = _bearing(robot, ball) + rng.uniform(-half_view, half_view)
    return {"x": robot[0], "y": robot[1], "phi": wrap(heading), "v": 0.0, "ball_x": ball[0], "ball_y": ball[1]}


def _bent(robot: Point, ball: Point, target: Point, apart: Mapping[str, Any]) -> bool:
    """Whether the corner at the ball is within the declared maximum; a straight line has 0."""
    corner = abs(wrap(_bearing(ball, target) - _bearing(robot, ball)))
    return bool(corner <= apart.get("corner_max_rad", math.pi))


def _waypoints(
    declared: Mapping[str, Any], rng: np.random.Generator
) -> tuple[dict[str, float], dict[str, dict[str, float]]]:
    field, labels, leg = declared["field"], declared["waypoints"]["labels"], declared["apart"]["leg_m"]
    points = [_point(field, rng)]
    while len(points) <= len(labels):
        following = _point(field, rng)
        if _within(points[-1], following, leg):
            points.append(following)
    off = declared["robot"]["half_view_rad"] if "robot" in declared else math.pi  # from the way to the first place
    ahead = _bearing(*points[:2]) if "robot" in declared else 0.0
    start = {"x": points[0][0], "y": points[0][1], "phi": wrap(ahead + rng.uniform(-off, off)), "v": 0.0}
    places = {label: {"x": x, "y": y} for label, (x, y) in zip(labels, points[1:], strict=True)}
    places[labels[-1]] |= {"phi": rng.uniform(-math.pi, math.pi), "v": 0.0}
    return start, places


def _event(
    row: Mapping[str, Any],
    start: Mapping[str, float],
    places: Mapping[str, Mapping[str, float]],
    rng: np.random.Generator,
) -> dict[str, float]:
    """An event: a move puts the ball aside of its place, a kick sends it off aside of the way to the target."""
    (target,) = places.values()
    ball = (start["ball_x"], start["ball_y"])
    side = rng.choice((-1.0, 1.0))
    direction = _bearing(ball, (target["x"], target["y"])) + side * rng.uniform(*row["aside_rad"])
    c, s = math.cos(direction), math.sin(direction)
    at = {"at_s": rng.uniform(*row["between_s"])}
    if "move_m" in row:
        distance = rng.uniform(*row["move_m"])
        return {
            **at,
            "ball_x": ball[0] + distance * c,
            "ball_y": ball[1] + distance * s,
            "ball_vx": 0.0,
            "ball_vy": 0.0,
        }
    speed = rng.uniform(*row["kick_mps"])
    return {**at, "ball_vx": speed * c, "ball_vy": speed * s}


def _point(field: Mapping[str, Any], rng: np.random.Generator) -> Point:
    return rng.uniform(*field["x_m"]), rng.uniform(*field["y_m"])


def _bearing(a: Point, b: Point) -> float:
    return math.atan2(b[1] - a[1], b[0] - a[0])


def _within(a: Point, b: Point, limits: tuple[float, float]) -> bool:
    return bool(limits[0] <= math.dist(a, b) <= limits[1])
