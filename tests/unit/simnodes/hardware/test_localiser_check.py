"""Two localisers on one topic are told from one that corrects itself."""

import random

import pytest

from tailor.schemas.messages import PoseEstimate
from tailor.simnodes.hardware.localiser_check import LocaliserCheck

FAULT = "jumps back and forth, expected one localiser"


def first_fault_s(places, rate_hz):
    """When a fault is found; each pose is expected where the last one was, since the robot stands."""
    check, last = LocaliserCheck(), None
    for k, place in enumerate(places):
        seen = PoseEstimate(round(1e9 * (1 + k / rate_hz)), *place, 1e-4, 1e-4, 1e-4)
        if last is not None and (text := check.fault(seen, last)):
            assert text == FAULT
            return k / rate_hz
        last = place
    return None


@pytest.mark.promise("P63")
@pytest.mark.parametrize("rate_hz", [4.0, 25.0], ids=["AMCL", "fast"])
@pytest.mark.parametrize("other", [(0.4, 0.0, 0.0), (9.0, 0.0, 0.0), (0.0, 0.0, 0.4), (0.0, 0.0, 3.0)])
def test_two_localisers_are_found_within_three_seconds(rate_hz, other):
    places = [(0.0, 0.0, 0.0), other] * 100
    assert first_fault_s(places, rate_hz) < 3.0


def test_a_localiser_that_finds_the_robot_elsewhere_now_and_then_has_no_fault():
    places = [(5.0 * (k // 100), 0.0, 1.5 * (k // 100)) for k in range(1000)]
    assert first_fault_s(places, 10.0) is None


def test_poses_without_stamps_are_not_judged():
    check, here, there = LocaliserCheck(), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    assert not any(check.fault(PoseEstimate(0, *there, 1e-4, 1e-4, 1e-4), here) for _ in range(100))


def test_a_noisy_localiser_has_no_fault():
    draw = random.Random(1)
    places = [tuple(draw.gauss(0.0, 0.06) for _ in range(3)) for _ in range(5000)]
    assert first_fault_s(places, 12.5) is None
