"""A localiser that is frozen, but looks fresh, is told from one of a robot at rest."""

import math

import pytest

from tailor.simnodes.hardware.pose_tracking import Drift, PoseTracker
from tests.unit.simnodes.hardware.test_pose_tracking import odometry, seen


def driven(seconds, correct, step=(0.01, 0.0)):
    """First fault of a tracker, by time: odometry at 50 Hz, each message with a way and a turn; a pose at 10 Hz."""
    tracker = PoseTracker(None, Drift())
    for k in range(round(50 * seconds)):
        at_s = 1.0 + 0.02 * k
        assert not tracker.move(odometry(at_s, step[0] * k, 0.0, math.remainder(step[1] * k, math.tau)))
        if k % 5 == 0 and (fault := tracker.correct(correct(at_s, k))):
            assert tracker.pose() is None
            return at_s - 1.0, fault
    return None


@pytest.mark.promise("P63")
@pytest.mark.parametrize(("step", "limit_s"), [((0.01, 0.0), 1.2), ((0.0, -0.02), 1.2)], ids=["way", "turn"])
@pytest.mark.parametrize("stamped", [0, 1])
def test_a_frozen_localiser_that_looks_fresh_is_found_within_half_a_metre_and_a_radian(step, limit_s, stamped):
    """The pose stayed where it was, and sure, for as long as the robot drove."""
    at_s, fault = driven(5.0, lambda at_s, _: seen(stamped * at_s, 3.0, 1.0, 0.5), step)
    assert (at_s < limit_s, fault) == (
        True,
        "repeats itself to the last digit while odometry moves: the localiser is frozen",
    )


def test_a_localiser_repeats_itself_for_as_long_as_the_robot_stands():
    jitter = (1e-3, -1e-3)
    tracker = PoseTracker(None, Drift())
    for k in range(20_000):
        assert not tracker.move(odometry(1.0 + 0.02 * k, jitter[k % 2], 0.0, jitter[k % 2] + 2e-6 * k))
        assert not tracker.correct(seen(1.0 + 0.02 * k, 3.0, 1.0, 0.5))


def test_a_localiser_that_changes_is_none_that_is_frozen():
    assert driven(60.0, lambda at_s, k: seen(at_s, 3.0 + 0.01 * k, 1.0, 0.5)) is None


def test_a_frozen_localiser_is_believed_again_once_its_pose_changes():
    tracker = PoseTracker(None, Drift())
    for k in range(100):
        tracker.move(odometry(1.0 + 0.02 * k, 0.01 * k, 0.0, 0.0))
        fault = tracker.correct(seen(1.0 + 0.02 * k, 3.0, 1.0, 0.5))
    assert (fault != "", tracker.known) == (True, False)
    assert tracker.correct(seen(3.0, 3.1, 1.0, 0.5)) == ""
    assert tracker.known


def test_a_base_that_begins_anew_makes_no_localiser_a_frozen_one():
    tracker = PoseTracker(None, Drift())
    tracker.move(odometry(1.0, 9.0, 0.0, 0.0))
    assert not tracker.correct(seen(1.0, 3.0, 1.0, 0.5))
    assert tracker.move(odometry(2.0, 0.0, 0.0, 0.0))
    assert not tracker.correct(seen(2.0, 3.0, 1.0, 0.5))
