"""A pose in the map from odometry and a localiser that speaks seldom."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tailor.schemas.messages import Odometry, PoseEstimate
from tailor.simnodes.hardware.localiser_check import Doubt
from tailor.simnodes.hardware.pose_tracking import Drift, PoseTracker, composed, inverse

POSES = st.tuples(st.floats(-9, 9), st.floats(-9, 9), st.floats(-3, 3))
STEPS = st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-3, 3))  # of a second


def odometry(stamp_s, x, y, phi):
    return Odometry(round(stamp_s * 1e9), x, y, phi, 0.0, 0.0)


def seen(stamp_s, x, y, phi):
    return PoseEstimate(round(stamp_s * 1e9), x, y, phi, 0.01, 0.02, 0.03)


def near(pose, expected):
    assert (pose.x, pose.y, math.cos(pose.phi), math.sin(pose.phi)) == pytest.approx(
        (*expected[:2], math.cos(expected[2]), math.sin(expected[2])), abs=1e-6
    )


def away_from_zero(pose):
    assume(max(map(abs, pose)) > 0.1)  # where odometry begins anew
    return pose


@given(POSES, POSES)
def test_inverse_undoes_a_pose(pose, other):
    x, y, phi = composed(inverse(pose), composed(pose, other))
    assert (x, y, math.cos(phi)) == pytest.approx((*other[:2], math.cos(other[2])), abs=1e-6)


@given(POSES, POSES, STEPS)
def test_a_start_is_carried_on_by_odometry(start, first, step):
    tracker = PoseTracker(start, Drift())
    tracker.move(odometry(1, *first))
    near(tracker.pose(), start)
    tracker.move(odometry(2, *away_from_zero(composed(first, step))))
    near(tracker.pose(), composed(start, step))


@given(POSES, POSES, STEPS)
def test_a_late_pose_of_the_localiser_holds_for_its_stamp(place, first, step):
    tracker = PoseTracker(None, Drift())
    tracker.move(odometry(1, *first))
    tracker.move(odometry(2, *away_from_zero(composed(first, step))))
    assert tracker.pose() is None
    tracker.correct(seen(1.1, *place))
    near(tracker.pose(), composed(place, step))


def test_doubt_grows_with_the_way_since_the_localiser_spoke_and_not_with_time():
    tracker = PoseTracker(None, Drift(0.1, 0.2))
    tracker.move(odometry(1, 0.0, 0.0, 0.0))
    tracker.correct(seen(1, 5.0, 5.0, 0.0))
    tracker.move(odometry(90, 0.0, 0.0, 0.0))
    assert (tracker.pose().var_x, tracker.pose().var_y, tracker.pose().var_phi) == (0.01, 0.02, 0.03)
    tracker.move(odometry(91, 2.0, 0.0, 0.5))
    expected = (0.01 + 0.2**2, 0.02 + 0.2**2, 0.03 + 0.1**2)
    assert (tracker.pose().var_x, tracker.pose().var_y, tracker.pose().var_phi) == pytest.approx(expected)


def test_a_localiser_without_odometry_gives_no_pose():
    tracker = PoseTracker(None, Drift())
    tracker.correct(seen(1, 5.0, 5.0, 0.0))
    assert tracker.pose() is None


@pytest.mark.parametrize(("step_m", "passed_s", "jumps"), [(5.0, 0.02, True), (0.6, 0.02, False), (5.0, 2.5, False)])
def test_odometry_that_jumps_makes_the_pose_unknown_until_the_localiser_speaks(step_m, passed_s, jumps):
    """A base that restarts counts from zero again: integrated as motion, the robot would be believed metres away."""
    tracker = PoseTracker((1.0, 2.0, 0.0), Drift())
    assert tracker.move(odometry(1.0, 0.0, 0.0, 0.0)) == ""
    assert tracker.move(odometry(1.0 + passed_s, step_m, 0.0, 0.0)) == (f"jumped by {step_m:.1f} m" if jumps else "")
    assert (tracker.pose() is None) is jumps
    tracker.move(odometry(1.1 + passed_s, step_m, 0.0, 0.0))
    assert (tracker.pose() is None) is jumps, "nor is it at its start again"
    tracker.correct(seen(1.1 + passed_s, 3.0, 3.0, 1.0))
    near(tracker.pose(), (3.0, 3.0, 1.0))


@pytest.mark.parametrize("pose", [(3.0, 1.0, 0.5), (0.2, 0.0, 0.0), (0.0, 0.0, 1.5)])
@pytest.mark.parametrize("again_s", [2.5, 100.0, -90.0], ids=["soon", "late", "with another clock"])
def test_odometry_that_begins_anew_after_a_silence_makes_the_pose_unknown(pose, again_s):
    """A base takes seconds to restart: enough time for metres, if it had driven."""
    tracker = PoseTracker((1.0, 2.0, 0.0), Drift())
    tracker.move(odometry(100.0, *pose))
    assert tracker.move(odometry(100.0 + again_s, 0.001, 0.0, 0.002)) == "began anew at zero"
    assert tracker.pose() is None


def test_odometry_that_goes_on_after_a_silence_or_passes_zero_is_carried_on():
    tracker = PoseTracker((1.0, 2.0, 0.0), Drift())
    for stamp_s, x in ((1.0, 0.0), (30.0, 0.0), (40.0, 2.0), (40.4, 0.0), (50.0, 0.05), (60.0, 0.0)):
        assert tracker.move(odometry(stamp_s, x, 0.0, 0.0)) == ""
    near(tracker.pose(), (1.0, 2.0, 0.0))


@pytest.mark.parametrize(
    ("pose", "again", "anew"),
    [
        ((0.4, 0.1, 0.2), (0.0, 0.0, 0.0), True),
        ((0.0, 0.0, -0.3), (0.0, -0.0, 0.0), True),
        ((0.4, 0.1, 0.2), (0.001, 0.0, 0.0), False),  # a robot that drives fast, perhaps
        ((0.09, 0.0, 0.0), (0.0, 0.0, 0.0), False),
    ],
)
def test_odometry_without_stamps_that_is_back_at_exactly_zero_makes_the_pose_unknown(pose, again, anew):
    tracker = PoseTracker((1.0, 2.0, 0.0), Drift())
    for each in ((0.0, 0.0, 0.0), pose):
        assert tracker.move(odometry(0.0, *each)) == ""
    assert tracker.move(odometry(0.0, *again)) == ("began anew at zero" if anew else "")
    assert (tracker.pose() is None) is anew


def test_a_heading_that_jumps_makes_the_pose_unknown():
    tracker = PoseTracker((1.0, 2.0, 0.0), Drift())
    tracker.move(odometry(1.0, 0.0, 0.0, 3.1))
    assert tracker.move(odometry(1.02, 0.0, 0.0, -3.1)) == ""
    assert tracker.move(odometry(1.04, 0.0, 0.0, -2.3)) == "jumped by 0.8 rad"
    assert tracker.pose() is None


def driven(stamped=True, seconds=10, mps=0.5):
    """A tracker of a robot that drives along x, with odometry ten times a second."""
    tracker = PoseTracker(None, Drift())
    for k in range(10 * seconds):
        tracker.move(odometry(k / 10 + 100 if stamped else 0, k / 10 * mps, 0.0, 0.0))
    return tracker


def test_odometry_without_stamps_is_that_of_now():
    tracker = driven(stamped=False)
    assert tracker.correct(seen(7.0, 20.0, 0.0, 0.0)) == ""
    near(tracker.pose(), (20.0, 0.0, 0.0))


def test_a_pose_of_another_clock_is_ignored_while_the_robot_drives():
    """Taken for the oldest odometry that is kept, it was metres behind."""
    tracker = driven(seconds=60)
    assert tracker.correct(seen(160.1, 20.0, 0.0, 0.0)) == ""
    assert tracker.correct(seen(100.0, 99.0, 0.0, 0.0)) == ("is 34.4 s from any odometry, expected stamps of one clock")
    assert tracker.correct(seen(200.0, 99.0, 0.0, 0.0)) != ""
    assert tracker.pose().x == pytest.approx(20.0, abs=0.1)


def test_a_pose_from_before_all_odometry_holds_for_a_robot_that_has_stood_since():
    """A localiser's last pose is kept for drivers that start later."""
    tracker = driven(mps=0.0)
    assert tracker.correct(seen(1.0, 5.0, 6.0, 1.0)) == ""
    near(tracker.pose(), (5.0, 6.0, 1.0))


LIMITS = Doubt(max_std_m=1.0, max_std_rad=0.5)


@pytest.mark.promise("P63")
@pytest.mark.parametrize(
    ("variances", "text"),
    [
        ((1e9, 0.01, 0.01), "the localiser is lost: standard deviation of 31622.78 m, beyond pose.max_std_m = 1"),
        ((0.01, 4.0, 0.01), "the localiser is lost: standard deviation of 2.00 m, beyond pose.max_std_m = 1"),
        ((0.01, 0.01, 3.29), "the localiser is lost: standard deviation of 1.81 rad, beyond pose.max_std_rad = 0.5"),
    ],
)
@pytest.mark.parametrize("start", [None, (1.0, 2.0, 0.0)], ids=["without a pose before", "with one"])
def test_a_localiser_that_is_lost_makes_the_pose_unknown_until_it_knows(start, variances, text):
    tracker = PoseTracker(start, Drift(), LIMITS)
    tracker.move(odometry(1, 0.0, 0.0, 0.0))
    assert tracker.correct(PoseEstimate(10**9, 5.0, 5.0, 0.0, *variances)) == text
    tracker.move(odometry(1.02, 0.0, 0.0, 0.0))
    assert tracker.pose() is None
    assert tracker.correct(PoseEstimate(10**9, 5.0, 5.0, 0.0, 0.25, 0.25, 0.0685)) == "", "AMCL's own first guess"
    near(tracker.pose(), (5.0, 5.0, 0.0))


@pytest.mark.promise("P63")
@pytest.mark.parametrize(("metres", "radians"), [(0.05, 0.0), (0.0, 0.025)], ids=["driving", "turning"])
def test_a_pose_that_odometry_alone_has_carried_too_far_is_unknown_until_the_localiser_speaks(metres, radians):
    """A localiser that has died says nothing: the robot would be driven by odometry alone for ever."""
    tracker, faults = PoseTracker(None, Drift(0.05, 0.05), LIMITS), {}
    tracker.move(odometry(0.1, 0.0, 0.0, 0.0))
    tracker.correct(seen(0.1, 0.0, 0.0, 0.0))
    for k in range(1, 600):
        if text := tracker.move(odometry(0.1 + 0.1 * k, metres * k, 0.0, math.remainder(radians * k, math.tau))):
            faults[k] = text
    (step,) = faults
    assert (0.95 < 0.05 * metres * step <= 1.01) or (0.45 < 0.05 * radians * step <= 0.51)
    assert "beyond pose.max_std_" in faults[step]
    assert tracker.pose() is None
    tracker.correct(seen(60.0, 3.0, 3.0, 1.0))
    near(tracker.pose(), (3.0, 3.0, 1.0))


def test_a_robot_without_a_localiser_is_carried_on_for_ever():
    tracker = PoseTracker((0.0, 0.0, 0.0), Drift())
    assert not any(tracker.move(odometry(0.1 + 0.1 * k, 0.05 * k, 0.0, 0.0)) for k in range(2000))
    assert tracker.pose().x == pytest.approx(99.95)


@pytest.mark.promise("P63")
def test_two_localisers_make_the_pose_unknown_until_one_speaks_alone():
    tracker, faults = PoseTracker(None, Drift(), LIMITS), []
    for k in range(1, 9):
        tracker.move(odometry(0.1 * k, 0.0, 0.0, 0.0))
        faults.append(tracker.correct(seen(0.1 * k, 1.0 * (k % 2), 0.0, 0.0)))
        if faults[-1]:
            break
    assert faults[-1] == "jumps back and forth, expected one localiser"
    assert tracker.pose() is None
    tracker.correct(seen(0.1 * k, 7.0, 3.0, 1.0))
    near(tracker.pose(), (7.0, 3.0, 1.0))
