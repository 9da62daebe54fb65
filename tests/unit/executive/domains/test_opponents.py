"""Believed opponents: one track each, better with every picture, gone when they are gone; and how they are drawn."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer import belief as soccer
from tailor.executive.domains.soccer import opponents
from tailor.schemas.messages import Sample
from tailor.schemas.messages.soccer import OpponentPercept, OpponentPercepts
from tailor.tools.lockstep.action_run import new_body
from tailor.tools.lockstep.readings import newest

POSE = Pose(1.0, -0.5, 0.7, (4e-4, 0.0, 0.0, 4e-4, 0.0, 2e-4))
PICTURE_NS = 80_000_000
SCENARIOS = ("opponents", "opponents-approach", "opponents-dribble")


def seen_from(pose, places, rng, lost=0.1):
    """Percepts of places (map frame) with the noise that they report."""
    c, s = math.cos(pose.phi), math.sin(pose.phi)
    made = []
    for x, y in places:
        ahead, left = c * (x - pose.x) + s * (y - pose.y), c * (y - pose.y) - s * (x - pose.x)
        along, across = 0.1 * rng.standard_normal(), 0.05 * rng.standard_normal()
        bearing = math.atan2(left, ahead)
        cb, sb = math.cos(bearing), math.sin(bearing)
        if rng.random() >= lost:
            made.append(OpponentPercept(
                ahead + cb * along - sb * across, left + sb * along + cb * across, 0.2,
                cb * cb * 0.01 + sb * sb * 0.0025, sb * sb * 0.01 + cb * cb * 0.0025, cb * sb * 0.0075,
            ))  # fmt: skip
    return tuple(made)


def looked(places, pictures, seed=0, before=opponents.NONE, lost=0.1):
    rng, known = np.random.default_rng(seed), before
    for k in range(1, pictures + 1):
        now_ns = before.seen_ns + k * PICTURE_NS
        known = opponents.see(known, POSE, now_ns, OpponentPercepts(0, seen_from(POSE, places, rng, lost)))
    return known


def ahead(*places):
    """Places in the map frame from places in the robot's."""
    c, s = math.cos(POSE.phi), math.sin(POSE.phi)
    return [(POSE.x + c * x - s * y, POSE.y + s * x + c * y) for x, y in places]


@pytest.mark.parametrize("seed", range(8))
def test_each_opponent_gets_one_track_whose_error_is_as_it_reports(seed):
    places = ahead((1.5, 0.0), (1.6, 0.55), (2.5, -0.8))
    standing = looked(places, 30, seed).standing
    assert len(standing) == 3
    for x, y in places:
        track = min(standing, key=lambda t: math.dist((t.x, t.y), (x, y)))
        assert math.dist((track.x, track.y), (x, y)) < 4 * track.sigma_m
        assert track.sigma_m < 0.06


def test_the_covariance_is_wider_along_the_line_of_sight_and_turned_with_the_robot():
    (track,) = looked(ahead((2.0, 0.0)), 2, lost=0.0).standing
    along = np.array([math.cos(POSE.phi), math.sin(POSE.phi)])
    across = np.array([-along[1], along[0]])
    covariance = np.array([[track.var_x, track.cov_xy], [track.cov_xy, track.var_y]])
    assert along @ covariance @ along > 2 * (across @ covariance @ across)
    assert np.linalg.eigvalsh(covariance).min() > 0


def test_one_percept_alone_does_not_count_yet():
    assert looked(ahead((2.0, 0.0)), 1, lost=0.0).standing == ()


def test_an_opponent_that_left_is_forgotten_and_one_out_of_view_is_not():
    known = looked(ahead((1.5, 0.0), (-1.5, 0.0)), 10, lost=0.0)  # nobody sees behind, but the track is there
    gone = looked(ahead((-1.5, 0.0)), 9, before=known, lost=0.0)
    assert [t.x for t in gone.standing] == pytest.approx([ahead((-1.5, 0.0))[0][0]], abs=0.2)


def test_an_opponent_moved_aside_is_a_new_track_with_the_number_free_for_it():
    known = looked(ahead((1.5, 0.0)), 10)
    moved = looked(ahead((1.5, 0.9)), 20, before=known)
    assert len(moved.standing) == 1
    assert moved.standing[0].y == pytest.approx(ahead((1.5, 0.9))[0][1], abs=0.15)


def test_a_flood_of_phantoms_costs_no_time_and_pushes_no_opponent_out():
    known = looked(ahead((1.5, 0.0)), 10, lost=0.0)
    rng, now_ns = np.random.default_rng(1), known.seen_ns
    for _ in range(50):
        now_ns += PICTURE_NS // 8
        places = rng.uniform(-15.0, 15.0, (80, 2))
        flood = tuple(OpponentPercept(*place, 0.2, 1e-6, 1e-6, 0.0) for place in places if math.hypot(*place) > 5.0)
        seen = seen_from(POSE, ahead((1.5, 0.0)), rng, lost=0.0)
        known = opponents.see(known, POSE, now_ns, OpponentPercepts(0, (*flood, *seen)))
        assert len(known.tracks) <= opponents.KEPT
    (x, y), near = ahead((1.5, 0.0))[0], known.standing[0]
    assert math.hypot(near.x - x, near.y - y) < 0.15


def test_without_pictures_the_robot_waits_once_it_knows_of_opponents():
    believed = replace(soccer.unknown(), poses_seen=99, time_ns=10**9)
    assert soccer.ready(believed), "nobody told it of opponents"
    sample = Sample("agilo/opponents", OpponentPercepts(0, ()), 10**9, 1)
    believed = soccer.update(believed, 10**9 + 400_000_000, (sample,), "agilo")
    assert soccer.ready(believed)
    assert not soccer.ready(soccer.update(believed, 10**9 + 600_000_000, (), "agilo"))


def test_telemetry_names_opponents_once_there_are_any():
    domain = domains.load("soccer")
    believed = replace(soccer.unknown(), opponents=looked(ahead((1.5, 0.0), (2.5, 0.5)), 10))
    values = dict(zip(domain.belief_names, domain.belief_values(believed), strict=False))
    assert values["opponent2_sigma (m)"] > 0 > values["opponent3_sigma (m)"]
    assert list(values)[9:] == list(opponents.NAMES)
    assert len(domain.belief_values(soccer.unknown())) == 9


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_opponents_matter_and_never_stand_on_start_goal_or_ball(scenario):
    near = total = 0
    for seed in range(150):
        drawn, start = domains.seeded_scenario("soccer", scenario, seed)
        at = (start["x"], start["y"])
        ball = (start["ball_x"], start["ball_y"]) if "ball_x" in start else None
        ends = [(p["x"], p["y"]) for p in drawn.places.values() if "x" in p]
        count = sum(name.endswith("_radius") for name in start)
        assert 1 <= count <= 4
        first = ball or ends[0]
        along = np.subtract(first, at) / math.dist(first, at)
        for n in range(1, count + 1):
            x, y, radius = (start[f"opponent{n}_{name}"] for name in ("x", "y", "radius"))
            assert math.dist((x, y), at) >= radius + 0.45
            assert all(math.dist((x, y), end) >= radius + 0.6 for end in ends)
            assert ball is None or math.dist((x, y), ball) >= radius + 0.4
            off = np.array([x, y]) - at
            ahead_m, aside_m = along @ off, abs(along[0] * off[1] - along[1] * off[0])
            near += 0 < ahead_m < math.dist(first, at) and aside_m < radius + 0.2
            total += 1
    assert near / total > 0.35, "so many are in the robot's straight way"


def test_the_executive_sees_the_opponents_that_the_simulator_places():
    domain = domains.load("soccer")
    _, start = domains.seeded_scenario("soccer", "opponents", 3)
    body, believed = new_body(domain), domain.initial_belief()
    start = {**start, "opponent1_x": start["x"] + 1.5, "opponent1_y": start["y"], "phi": 0.0}
    body.reset(np.random.default_rng(0), start)
    for tick in range(1, 20):
        body.command((0.0, 0.0))
        believed = domain.update(believed, tick * 10**8, newest(body.advance(10**8)), (0.0, 0.0))
    nearest = min(
        math.dist((t.x, t.y), (start["opponent1_x"], start["opponent1_y"])) for t in believed.opponents.standing
    )
    assert nearest < 0.15
