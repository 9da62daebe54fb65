"""The pose filter and the ball's track: angles wrap, covariances stay covariances, estimates get better."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.belief import ball_track
from tailor.executive.belief.angles import difference, wrap
from tailor.executive.belief.ball_track import BallTrack
from tailor.executive.belief.planar_ekf import OdometryNoise, Pose, correct, predict

NOISE = OdometryNoise(4e-4, 1e-4, 1e-3, 2e-5)
moderate = st.floats(-20, 20)
angle = st.floats(-math.pi, math.pi)


@given(st.floats(-1e4, 1e4), st.integers(-5, 5))
def test_an_angle_is_wrapped_into_one_turn_and_stays_the_same_angle(value, turns):
    wrapped = wrap(value)
    assert -math.pi <= wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(value), abs=1e-9)
    assert abs(difference(value + turns * math.tau, value)) < 1e-9


def matrix(covariance):
    xx, xy, xp, yy, yp, pp = covariance
    return np.array([[xx, xy, xp], [xy, yy, yp], [xp, yp, pp]])


moves = st.tuples(st.floats(-0.9, 0.9), st.floats(-1.75, 1.75), st.floats(0, 0.5))
sights = st.tuples(st.floats(-3, 3), st.floats(-2, 2), angle)


@settings(deadline=None)
@given(st.lists(st.one_of(moves.map(lambda m: ("move", m)), sights.map(lambda s: ("see", s))), max_size=40))
def test_covariance_stays_symmetric_and_positive_whatever_comes(history):
    pose = Pose(0.0, 0.0, 0.0, (0.01, 0.0, 0.0, 0.01, 0.0, 0.01))
    for kind, values in history:
        pose = predict(pose, *values, NOISE) if kind == "move" else correct(pose, *values, (0.02, 0.02, 0.016))
        assert np.linalg.eigvalsh(matrix(pose.covariance)).min() > -1e-12
        assert -math.pi <= pose.phi <= math.pi


@settings(deadline=None)
@given(sights, sights, st.floats(1e-4, 1.0))
def test_seeing_never_makes_the_pose_less_certain(true, seen, variance):
    pose = Pose(*true, (0.05, 0.01, 0.0, 0.04, 0.0, 0.02))
    after = correct(pose, *seen, (variance, variance, variance))
    assert all(after.covariance[i] <= pose.covariance[i] + 1e-12 for i in (0, 3, 5))


def test_heading_seen_across_the_seam_of_angles_turns_the_short_way():
    pose = Pose(0.0, 0.0, math.pi - 0.1, (0.01, 0.0, 0.0, 0.01, 0.0, 0.01))
    after = correct(pose, 0.0, 0.0, -math.pi + 0.1, (0.01, 0.01, 0.01))
    assert abs(after.phi) == pytest.approx(math.pi)


def test_prediction_agrees_with_the_jacobian_of_the_motion():
    pose, v, omega, t = Pose(0.3, -0.2, 0.7, (0.02, 0.004, 0.001, 0.03, -0.002, 0.01)), 0.6, 0.9, 0.2
    none = OdometryNoise(0.0, 0.0, 0.0, 0.0)

    def end(x, y, phi):
        p = predict(Pose(x, y, phi, pose.covariance), v, omega, t, none)
        return np.array([p.x, p.y, p.phi])

    h, at = 1e-6, np.array([pose.x, pose.y, pose.phi])
    jacobian = np.column_stack([(end(*(at + h * e)) - end(*(at - h * e))) / (2 * h) for e in np.eye(3)])
    expected = jacobian @ matrix(pose.covariance) @ jacobian.T
    assert matrix(predict(pose, v, omega, t, none).covariance) == pytest.approx(expected, abs=1e-9)


@given(st.floats(0.1, 3.0), angle, st.floats(0, 2))
def test_free_ball_comes_to_rest_after_the_way_that_friction_allows(speed, direction, heading):
    vx, vy = speed * math.cos(direction), speed * math.sin(direction)
    track = BallTrack(1.0, 0.0, vx, vy, 1e-4, 0)
    for _ in range(700):
        track = ball_track.move(track, 0.0, 0.0, heading, 0.01, 0.53)
    assert math.hypot(track.vx, track.vy) == 0.0
    assert math.hypot(track.ahead - 1.0, track.left) == pytest.approx(speed**2 / (2 * 0.53), rel=0.02)


@given(st.floats(0.3, 3), st.floats(-1, 1), st.floats(-0.9, 0.9), st.floats(-0.3, 0.3))
def test_resting_ball_stays_where_it_is_while_the_robot_drives(ahead, left, v, turn):
    track = ball_track.move(BallTrack(ahead, left, 0.0, 0.0, 1e-4, 0), v, turn, 0.4 + turn / 2, 0.2, 0.53)
    x, y = v * 0.2 * math.cos(0.4 + turn / 2), v * 0.2 * math.sin(0.4 + turn / 2)
    phi = 0.4 + turn
    was = (math.cos(0.4) * ahead - math.sin(0.4) * left, math.sin(0.4) * ahead + math.cos(0.4) * left)
    now = (
        x + math.cos(phi) * track.ahead - math.sin(phi) * track.left,
        y + math.sin(phi) * track.ahead + math.cos(phi) * track.left,
    )
    assert math.dist(was, now) < 0.2 * abs(turn) * abs(v) + 1e-9  # the step drives along the middle heading


def sight(ahead, left, along=1e-3, across=1e-3, bearing=0.0):
    """A percept that errs by these variances (m²) along a line of sight in that direction, and across it."""
    c, s = math.cos(bearing), math.sin(bearing)
    return ball_track.Seen(ahead, left, c * c * along + s * s * across, s * s * along + c * c * across,
                           c * s * (along - across))  # fmt: skip


def test_a_ball_put_elsewhere_is_believed_at_once():
    track = BallTrack(1.0, 0.0, 0.0, 0.0, 1e-3, 0)
    moved = ball_track.see(track, sight(1.5, 0.4), 0.0, 80_000_000)
    assert (moved.ahead, moved.left) == (1.5, 0.4)


@given(st.floats(-0.8, 0.8))
def test_noise_along_the_line_of_sight_moves_no_ball_but_the_same_across_it_does(bearing):
    c, s = math.cos(bearing), math.sin(bearing)
    track = BallTrack(3.0 * c, 3.0 * s, 0.0, 0.0, 1e-3, 0)
    for off, surprising in ((0.7, False), (0.9, True)):  # 16 cm of noise at 3 m, half as much across
        along = sight((3.0 + off) * c, (3.0 + off) * s, 0.0256, 0.0064, bearing)
        seen = ball_track.see(track, along, 0.0, 80_000_000)
        assert ((seen.ahead, seen.left) == (along.ahead, along.left)) == surprising
    across = sight(3.0 * c - 0.7 * s, 3.0 * s + 0.7 * c, 0.0256, 0.0064, bearing)
    assert ball_track.see(track, across, 0.0, 80_000_000).ahead == across.ahead


def test_rolling_ball_is_tracked_with_its_speed():
    rng, track = np.random.default_rng(1), None
    for step in range(40):
        x = 1.0 + 0.8 * 0.08 * step
        if track is not None:
            track = ball_track.move(track, 0.0, 0.0, 0.0, 0.08, 0.0)
        percept = sight(x + 0.02 * rng.standard_normal(), 0.0, 4e-4, 4e-4)
        track = ball_track.see(track, percept, 0.0, 80_000_000 * step)
    assert track.vx == pytest.approx(0.8, abs=0.15)
    assert track.ahead == pytest.approx(x, abs=0.05)
