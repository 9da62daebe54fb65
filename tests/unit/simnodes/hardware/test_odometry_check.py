"""Odometry of two publishers, with false speeds, or frozen, is told from that of one robot, moving or at rest."""

import math

import pytest

from tailor.schemas.messages import Odometry
from tailor.simnodes.hardware.odometry_check import OdometryCheck, RepetitionCheck

PERIOD_S = 0.02
FROZEN = "repeats itself to the last digit while the robot is to move: it is frozen, or the base does not obey"
FAULT = "moves more than its own speeds say, expected one publisher, with true speeds"


def circling(seconds, mps=0.9, radps=1.75, scale=1.0, stamped=True):
    """Odometry of a robot that drives in circles, whose speeds are true at a scale of 1."""
    for k in range(1, round(seconds / PERIOD_S) + 1):
        phi = radps * PERIOD_S * k
        x, y = mps / radps * math.sin(phi), mps / radps * (1.0 - math.cos(phi))
        turned = math.remainder(phi, math.tau)
        yield Odometry(round(1e9 * PERIOD_S * k) * stamped, x, y, turned, scale * mps, scale * radps)


def first_fault_s(odometry):
    """When a fault is found in a stream, and its text."""
    check = OdometryCheck()
    return next(((1e-9 * each.stamp_ns, text) for each in odometry if (text := check.fault(each))), None)


def beside(odometry, dx, dphi):
    """Each message followed by that of another publisher, elsewhere."""
    for each in odometry:
        yield each
        yield Odometry(each.stamp_ns, each.x + dx, each.y, each.phi + dphi, each.v, each.omega)


def test_odometry_of_one_robot_has_no_fault():
    assert first_fault_s(circling(60.0)) is None
    assert first_fault_s(circling(60.0, scale=0.8)) is None


@pytest.mark.promise("P63")
@pytest.mark.parametrize(("dx", "dphi"), [(0.25, 0.0), (0.03, 0.0), (0.0, 0.03), (5.0, 1.0)])
def test_two_publishers_are_found_within_a_second(dx, dphi):
    at_s, text = first_fault_s(beside(circling(2.0, mps=0.1, radps=0.1), dx, dphi))
    assert (at_s < 1.0, text) == (True, FAULT)


def test_odometry_without_its_speeds_is_found_within_three_seconds():
    at_s, text = first_fault_s(circling(5.0, scale=0.0))
    assert (at_s < 3.0, text) == (True, FAULT)


def test_a_correction_of_half_a_metre_now_and_then_is_none():
    messages = list(circling(60.0))
    corrected = [Odometry(o.stamp_ns, o.x + 0.5 * (k // 200), o.y, o.phi, o.v, o.omega) for k, o in enumerate(messages)]
    assert first_fault_s(corrected) is None


def test_odometry_without_stamps_is_not_judged():
    assert first_fault_s(circling(60.0, scale=0.0, stamped=False)) is None


def first_repetition_s(odometry, command=(0.0, 0.0), period_s=PERIOD_S):
    """When repetitions are found in a stream that a command goes with, and their text."""
    check = RepetitionCheck()
    times = (
        (k * period_s, text) for k, each in enumerate(odometry) if (text := check.fault(each, command, k * period_s))
    )
    return next(times, None)


@pytest.mark.promise("P63")
@pytest.mark.parametrize("period_s", [0.02, 0.25])
@pytest.mark.parametrize(
    ("speeds", "command", "limit_s"),
    [
        ((0.4, 0.0), (0.0, 0.0), 0.8),
        ((0.0, -1.0), (0.0, 0.0), 0.6),
        ((0.0, 0.0), (-0.4, 0.0), 1.8),
        ((0.0, 0.0), (0.0, 1.0), 1.6),
        ((0.1, 0.0), (0.4, 0.0), 1.8),
    ],
)
def test_frozen_odometry_is_found_before_the_robot_has_gone_far(speeds, command, limit_s, period_s):
    """Without stamps it was fresh for ever, and drove a robot through a wall."""
    frozen = [Odometry(0, 1.0, 2.0, 0.5, *speeds)] * 1000
    at_s, text = first_repetition_s(frozen, command, period_s)
    assert (at_s <= limit_s + period_s, text) == (True, FROZEN)


def test_a_robot_at_rest_repeats_itself_for_hours():
    rest = [Odometry(0, 1.0, 2.0, 0.5, 0.0, 0.0)] * 100_000
    assert first_repetition_s(rest) is None
    assert first_repetition_s(rest, (0.05, -0.1)) is None, "too little for its motors"
    creeping = [Odometry(0, 1.0, 2.0, 0.5, 0.02, 0.05)] * 100_000
    assert first_repetition_s(creeping) is None, "the offset of a gyroscope"


@pytest.mark.parametrize("scale", [1.0, 0.0], ids=["its speeds", "no speeds"])
@pytest.mark.parametrize("stamped", [True, False])
def test_a_robot_that_moves_does_not_repeat_itself(scale, stamped):
    assert first_repetition_s(circling(60.0, scale=scale, stamped=stamped), (0.9, 1.75)) is None


def test_a_base_may_take_a_second_to_begin_to_move_each_time():
    check, at_rest = RepetitionCheck(), Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for start in range(20):
        for k in range(100):
            command = (0.9, 1.75) if k < 60 else (0.0, 0.0)  # it is to stop again soon after
            assert not check.fault(at_rest, command, 2.0 * start + PERIOD_S * k)


def test_a_pause_of_the_driver_is_no_motion():
    check, frozen = RepetitionCheck(), Odometry(0, 1.0, 2.0, 0.5, 0.5, 0.0)
    assert not check.fault(frozen, (0.5, 0.0), 0.0)
    assert not check.fault(frozen, (0.5, 0.0), 60.0)
