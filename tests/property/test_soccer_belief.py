"""Whatever legal numbers the bus brings, nothing raises in the soccer robot's belief, and nothing poisons it."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive import domains
from tailor.executive.core.sensing.measurements import MAX_PLACE_M
from tailor.executive.domains.soccer import belief as soccer
from tailor.schemas import messages as m
from tailor.schemas.messages import Sample
from tailor.schemas.messages.soccer import BallPercept, OpponentPercept, OpponentPercepts
from tailor.schemas.numbers import MAX_FROM_ROBOT, MAX_NUMBER

SOCCER = domains.load("soccer")
ANY = st.floats(-MAX_NUMBER, MAX_NUMBER) | st.sampled_from([0.0, MAX_NUMBER, -MAX_NUMBER, 5e-324])
ANGLE = st.floats(-math.pi, math.pi)
VARIANCE = st.floats(0.0, MAX_NUMBER) | st.sampled_from([0.0, 5e-324, MAX_NUMBER])
STAMP = st.integers(0, 2**62)
OPPONENT = st.builds(OpponentPercept, ANY, ANY, ANY, VARIANCE, VARIANCE, ANY)
READINGS = st.one_of(
    st.builds(m.Odometry, STAMP, ANY, ANY, ANGLE, ANY, ANY),
    st.builds(m.PoseEstimate, STAMP, ANY, ANY, ANGLE, VARIANCE, VARIANCE, VARIANCE),
    st.builds(BallPercept, STAMP, ANY, ANY, VARIANCE, VARIANCE, ANY),
    st.builds(OpponentPercepts, STAMP, st.lists(OPPONENT, max_size=6).map(tuple)),
)


@pytest.mark.promise("P19")
@given(st.lists(READINGS, max_size=40))
@settings(deadline=None, max_examples=100)
def test_no_legal_reading_leaves_the_belief_without_a_number(readings):
    belief = soccer.unknown()
    for k, reading in enumerate(readings, start=1):
        now_ns = k * 80_000_000
        belief = soccer.update(belief, now_ns, (Sample("any", reading, now_ns, k),), "agilo")
        assert all(math.isfinite(value) for value in SOCCER.belief_values(belief))


NEAR = st.floats(-MAX_FROM_ROBOT, MAX_FROM_ROBOT) | st.sampled_from([MAX_FROM_ROBOT, -MAX_FROM_ROBOT])
ON_MAP = st.floats(-MAX_PLACE_M, MAX_PLACE_M) | st.sampled_from([MAX_PLACE_M, -MAX_PLACE_M])
RECEIVED = st.one_of(
    st.builds(m.PoseEstimate, STAMP, ON_MAP, ON_MAP, ANGLE, VARIANCE, VARIANCE, VARIANCE),
    st.builds(BallPercept, STAMP, NEAR, NEAR, VARIANCE, VARIANCE, ANY),
    st.builds(OpponentPercepts, STAMP, st.lists(st.builds(OpponentPercept, *[NEAR] * 3, VARIANCE, VARIANCE, ANY))),
)


@pytest.mark.promise("P19")
@given(st.lists(st.tuples(st.sampled_from([1, 80, 100_000]), RECEIVED), max_size=20))
@settings(deadline=None, max_examples=100)
def test_a_report_of_what_is_believed_after_any_received_percepts_can_be_read(readings):
    """A ball that jumps by as much in a millisecond rolls on for as long as it takes."""
    belief, now_ns = soccer.unknown(), 0
    for k, (passed_ms, reading) in enumerate(readings, start=1):
        now_ns += passed_ms * 1_000_000
        belief = soccer.update(belief, now_ns, (Sample("any", reading, now_ns, k),), "agilo")
    belief = soccer.update(belief, now_ns + 10**15, (), "agilo")
    assert max(map(abs, SOCCER.belief_values(belief))) <= MAX_NUMBER


def test_poses_with_a_covariance_of_zeros_are_fused_and_not_divided_by():
    """ROS nodes that know no covariance leave it zero."""
    belief = soccer.unknown()
    for k in range(1, 40):
        pose = m.PoseEstimate(k, 0.5 + 0.001 * (k % 2), 0.2, 0.1, 0.0, 0.0, 0.0)
        belief = soccer.update(belief, k * 80_000_000, (Sample("agilo/pose", pose, k * 80_000_000, k),), "agilo")
    assert soccer.ready(belief)
    assert abs(belief.pose.x - 0.5) < 0.01


def test_odometry_that_no_robot_could_drive_is_ignored():
    belief = soccer.unknown()
    for k, (v, omega) in enumerate([(0.2, 0.0), (1e9, 0.0), (0.0, 1e9)], start=1):
        odom = m.Odometry(k * 20_000_000, 0.0, 0.0, 0.0, v, omega)
        belief = soccer.update(belief, k * 20_000_000, (Sample("agilo/odom", odom, k * 20_000_000, k),), "agilo")
    assert (belief.v, belief.omega) == (0.2, 0.0)
    assert abs(belief.pose.x) < 0.05
