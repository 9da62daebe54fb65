"""A robot that is not at the other ends of its topics is named as such, instead of being driven into the void."""

import pytest

from tailor.simnodes.hardware.other_ends import OtherEnds

NOBODY = r"cmd_vel: nobody takes commands there, expected the base \(topics.cmd_vel\)"
NOTHING = r"odom: nothing comes from there, expected odometry \(topics.odom\)"


@pytest.mark.promise("P63")
def test_a_command_that_nobody_takes_is_named_after_a_moment():
    ends = OtherEnds("cmd_vel", "odom", "amcl_pose", 10.0)
    assert not ends.obeys(False, 11.5)
    with pytest.raises(ValueError, match=NOBODY):
        ends.obeys(False, 11.51)


def test_a_base_that_comes_in_time_is_driven_from_then_on():
    ends = OtherEnds("cmd_vel", "odom", "amcl_pose", 10.0)
    assert not ends.obeys(False, 11.0)
    assert ends.obeys(True, 11.4)
    assert ends.obeys(False, 12.9), "a look in between may miss it"


@pytest.mark.promise("P63")
def test_a_base_that_goes_is_named_so_that_none_obeys_when_it_comes_back_unarmed():
    ends = OtherEnds("cmd_vel", "odom", "amcl_pose", 10.0)
    for tenth in range(100):
        assert ends.obeys(True, 10.0 + 0.1 * tenth)
    with pytest.raises(ValueError, match=NOBODY):
        ends.obeys(False, 21.5)


def test_odometry_that_never_comes_is_named_by_its_topic():
    ends = OtherEnds("cmd_vel", "odom", "amcl_pose", 10.0)
    ends.measures(False, 12.0)
    with pytest.raises(ValueError, match=NOTHING):
        ends.measures(False, 12.01)


def test_odometry_that_has_come_is_watched_by_the_driver():
    ends = OtherEnds("cmd_vel", "odom", "amcl_pose", 10.0)
    ends.measures(True, 10.5)
    ends.measures(False, 99.0)


@pytest.mark.parametrize(
    ("may_speak", "why"), [(True, "nothing has come from there yet"), (False, "nobody publishes there")]
)
def test_a_localiser_that_is_silent_from_the_start_is_named_by_its_topic(may_speak, why):
    ends = OtherEnds("cmd_vel", "odom", "amcl_pose", 10.0)
    assert ends.unlocated(False, may_speak, 12.0) == ""
    assert ends.unlocated(False, may_speak, 12.01) == f"amcl_pose: {why}, expected the localiser (topics.pose)"
    assert ends.unlocated(True, may_speak, 12.02) == "", "it may rest while the robot does"


def test_a_robot_without_a_localiser_misses_none():
    assert OtherEnds("cmd_vel", "odom", "", 10.0).unlocated(False, False, 99.0) == ""
