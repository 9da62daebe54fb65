"""Odometry of two publishers, or with false speeds, is told from that of one robot."""

import math

import pytest

from tailor.schemas.messages import Odometry
from tailor.simnodes.hardware.odometry_check import OdometryCheck

PERIOD_S = 0.02
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
