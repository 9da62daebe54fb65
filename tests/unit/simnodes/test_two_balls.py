"""A second ball on the simulated field: it rolls, is seen and is hit like the first, and leaves no trace."""

import math

import numpy as np
import pytest

from tailor.schemas.messages.soccer import BallPercept, BallTruth
from tailor.simnodes.agilo.body import AgiloBody

TICK_NS = 100_000_000
BOTH = {"ball_x": 1.2, "ball_y": 0.0, "ball2_x": 2.0, "ball2_y": 0.0}


def driven(start, ticks=40, command=(0.0, 0.0), body=None):
    body = body or AgiloBody()
    body.reset(np.random.default_rng(1), start)
    return body, advanced(body, ticks, command)


def advanced(body, ticks, command=(0.0, 0.0)):
    readings = []
    for _ in range(ticks):
        body.command(command)
        readings += body.advance(TICK_NS)
    return readings


def second(readings):
    return [reading.message for reading in readings if reading.topic == "ball2_truth"]


def test_both_balls_roll_alike_and_meet():
    body, readings = driven({**BOTH, "ball_vx": 0.8})
    apart_m = 2 * 0.11
    assert second(readings)[-1].x > 2.0, "the first has hit it"
    assert second(readings)[-1].x - body.ground_truth().ball_x > apart_m - 0.005
    body, _ = driven({"ball_x": 1.0, "ball_y": 1.0, "ball_vx": 0.8})
    _, readings = driven({"ball2_x": 1.0, "ball2_y": 1.0, "ball2_vx": 0.8})
    assert second(readings)[-1].x == pytest.approx(body.ground_truth().ball_x, abs=1e-3)


def test_the_robot_pushes_the_second_ball():
    _, readings = driven({"ball2_x": 1.0, "ball2_y": 0.0}, 40, (0.5, 0.0))
    assert second(readings)[-1].x > 1.5


def test_the_camera_measures_each_ball_on_its_topic():
    _, readings = driven({**BOTH, "ball2_y": 1.0})
    for topic, (x, y) in (("ball", (1.2, 0.0)), ("ball2", (2.0, 1.0))):
        seen = [reading.message for reading in readings if reading.topic == topic]
        assert all(isinstance(percept, BallPercept) for percept in seen)
        assert np.mean([(percept.x, percept.y) for percept in seen], axis=0) == pytest.approx((x, y), abs=0.06)
    _, readings = driven({"ball_x": 1.2, "ball2_x": -2.0, "ball2_y": 0.0})
    assert not any(reading.topic == "ball2" for reading in readings), "it is behind the robot"


def test_a_field_with_one_ball_after_one_with_two_is_as_before():
    start = {"ball_x": 1.0, "ball_y": 0.1, "opponent1_x": 2.0, "opponent1_y": -1.0}
    body, fresh = driven(start, 40, (0.5, 0.2))
    driven({**start, "ball2_x": 0.5, "ball2_y": 0.0}, 10, (0.5, 0.0), body)
    _, readings = driven(start, 40, (0.5, 0.2), body)
    assert readings == fresh
    assert not second(readings)


def test_a_second_ball_placed_on_the_way_changes_nothing_at_once():
    """Robot, first ball and opponents go on where they were, as fast."""
    start = {"ball_x": 0.8, "ball_y": 0.0, "opponent1_x": 2.0, "opponent1_y": -1.0, "opponent1_radius": 0.15}
    body, alone = driven(start, 30, (0.5, 0.3)), driven(start, 30, (0.5, 0.3))
    body, alone = body[0], alone[0]
    body.place({"ball2_x": -1.0, "ball2_y": 0.0})
    assert body.ground_truth() == alone.ground_truth()
    with_two, readings = advanced(body, 5, (0.5, 0.3)), advanced(alone, 5, (0.5, 0.3))
    a, b = body.ground_truth(), alone.ground_truth()
    assert math.dist((a.x, a.y, a.ball_x, a.ball_y), (b.x, b.y, b.ball_x, b.ball_y)) < 1e-6
    truths = [[each.message for each in some if each.topic == "opponents_truth"] for some in (with_two, readings)]
    assert truths[0] == truths[1]
    assert second(with_two)[0] == BallTruth(3_100_000_000, -1.0, 0.0, 0.0, 0.0)
