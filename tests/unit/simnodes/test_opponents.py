"""Opponents on the simulated field: they block the robot, touching them shows in the truth, the camera sees them."""

import math

import numpy as np
import pytest

from tailor.schemas.messages.soccer import OpponentPercepts, OpponentsTruth
from tailor.simnodes.agilo.body import AgiloBody
from tailor.simnodes.agilo.opponents import BODIES

TICK_NS = 100_000_000
AHEAD = {"opponent1_x": 1.5, "opponent1_y": 0.0, "opponent1_radius": 0.15}


def driven(start, ticks=40, command=(0.5, 0.0), body=None):
    body = body or AgiloBody()
    body.reset(np.random.default_rng(1), start)
    readings = []
    for _ in range(ticks):
        body.command(command)
        readings += body.advance(TICK_NS)
    return body, readings


def messages(readings, kind):
    return [reading.message for reading in readings if isinstance(reading.message, kind)]


@pytest.mark.parametrize("radius_m", [0.15, 0.25])
def test_an_opponent_stops_the_robot_at_its_side(radius_m):
    body, readings = driven({**AHEAD, "opponent1_radius": radius_m})
    rail_m = 1.5 - radius_m - body.ground_truth().x
    assert 0.2 < rail_m < 0.32, "the round opponent lies in the rail"
    truths = messages(readings, OpponentsTruth)
    assert not truths[0].touched
    assert any(truth.touched for truth in truths[20:])
    assert truths[0].opponents[0].radius_m == radius_m


@pytest.mark.parametrize("radius_m", [0.0, -0.2, math.nan, math.inf, 2.1])
def test_an_opponent_that_is_none_is_refused(radius_m):
    expected = f"opponent2_radius is {radius_m:g} m, expected above 0 and at most 2"
    assert AgiloBody().refusal({"opponent2_radius": radius_m}) == expected
    assert AgiloBody().refusal({"opponent2_radius": 0.2, "x": 1.0}) == ""
    assert not AgiloBody().refusal({"opponent2_radius": 2.0, "x": 1.0})


def test_a_robot_that_passes_beside_it_touches_nothing():
    _, readings = driven({**AHEAD, "opponent1_y": 0.36})
    assert not any(truth.touched for truth in messages(readings, OpponentsTruth))
    _, readings = driven({**AHEAD, "opponent1_y": 0.27})
    assert any(truth.touched for truth in messages(readings, OpponentsTruth))


def test_an_empty_field_after_one_with_opponents_is_as_before():
    body, fresh = driven({"ball_x": 1.0, "ball_y": 0.1})
    driven({**AHEAD, "opponent4_x": 0.5, "opponent4_y": 1.0}, body=body)
    _, readings = driven({"ball_x": 1.0, "ball_y": 0.1}, body=body)
    assert readings == fresh
    assert not messages(readings, OpponentPercepts)
    assert not messages(readings, OpponentsTruth)


def test_the_camera_sees_those_in_view_with_noise_and_now_and_then_overlooks_one():
    start = {f"{name}_{axis}": value for name, at in zip(BODIES, [(2, 0), (-2, 0), (2, 1)], strict=False)
             for axis, value in zip("xy", at, strict=True)}  # fmt: skip
    _, readings = driven(start, 300, (0.0, 0.0))
    percepts = messages(readings, OpponentPercepts)
    assert len(percepts) == 300 * 10 // 8
    counts = [len(picture.opponents) for picture in percepts]
    assert np.mean(counts) == pytest.approx(2 * 0.9, abs=0.1)
    seen = [opponent for picture in percepts for opponent in picture.opponents]
    ahead = np.array([(o.x, o.y) for o in seen if o.y < 0.5 and abs(math.atan2(o.y, o.x)) < 0.25])
    assert ahead[:, 0].mean() == pytest.approx(2.0, abs=0.05)
    assert ahead[:, 0].std() == pytest.approx(0.11, rel=0.3), "5 % of the range and a centimetre"


def test_an_opponent_can_be_put_elsewhere_while_the_clock_runs():
    body, _ = driven(AHEAD, 5)
    body.place({"opponent1_y": 1.5, "opponent2_x": -1.0})
    body.command((0.5, 0.0))
    (truth,) = messages(body.advance(TICK_NS), OpponentsTruth)
    assert [(o.x, o.y) for o in truth.opponents] == [(1.5, 1.5), (-1.0, 0.0)]
    assert truth.opponents[0].radius_m == 0.15
