"""Odometry against poses: one that reports less than the robot moves is refused, whatever noise does not explain it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tailor.executive.core.sensing.measurements import Measurements, without_faulty
from tailor.schemas.messages import Odometry, PoseEstimate, Sample

TICK_NS = 100_000_000


def faults(speeds, places, omega=0.0, sigma_m=0.0, fastest=(2.0, 2.0), every=1, until=999):
    """The fault of odometry in each tick, by reported speeds (m/s) and the places of poses (m)."""
    known, found = Measurements(), []
    for n, (speed, (x, y)) in enumerate(zip(speeds, places, strict=True)):
        odometry = Sample("agilo/odom", Odometry(0, 0.0, 0.0, 0.0, speed, omega), n * TICK_NS, n)
        pose = Sample("agilo/pose", PoseEstimate(0, x, y, 0.0, sigma_m**2, sigma_m**2, 0.01), n * TICK_NS, n)
        samples = (pose, odometry) if n % every == 0 and n < until else (odometry,)
        known, _ = without_faulty(known, samples, fastest)
        found.append(known.faults.get("agilo/odom", ""))
    return found


def straight(speed, ticks=40, stands_from=math.inf):
    return [(speed * 0.1 * min(n, stands_from), 1.0) for n in range(ticks)]


@pytest.mark.parametrize("every", [1, 2])
def test_odometry_of_a_standing_robot_that_drives_is_refused_after_a_second_until_it_stands(every):
    found = faults([0.0] * 40, straight(0.45, stands_from=20), every=every)
    assert found[:10] == [""] * 10
    assert set(found[12:21]) == {"has v at 0 while poses move at 0.45 m/s"}
    assert found[30:] == [""] * 10


def test_a_speed_that_is_half_of_the_true_one_is_refused():
    assert faults([0.3] * 20, straight(0.8, 20))[-1] == "has v at 0.3 while poses move at 0.8 m/s"


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("sigma_m", [0.0, 0.02, 0.06])
def test_noise_and_a_wrong_scale_of_the_wheels_are_no_contradiction(sigma_m, seed):
    rng = np.random.default_rng(seed)
    speeds = np.minimum(2.0, np.abs(np.cumsum(rng.normal(0.0, 0.05, 300))))  # m/s, by 0.5 m/s² and more
    way = np.cumsum(0.1 * 1.1 * speeds) + rng.normal(0.0, sigma_m, 300)
    assert set(faults(speeds, [(x, 0.0) for x in way], sigma_m=sigma_m)) == {""}


def test_neither_a_robot_that_was_put_elsewhere_nor_poses_that_jump_to_and_fro_contradict():
    put_down = [(0.0, 0.0)] * 20 + [(3.0, 0.0)] * 20
    to_and_fro = [(3.0 * (n // 5 % 2) + 0.01 * n, 0.0) for n in range(40)]
    assert set(faults([0.0] * 40, put_down)) == set(faults([0.0] * 40, to_and_fro)) == {""}
    put_ahead = [(x + (3.0 if n > 20 else 0.0), y) for n, (x, y) in enumerate(straight(0.4))]
    assert set(faults([0.4] * 40, put_ahead)) == {""}


def test_what_the_noise_of_poses_may_be_is_no_contradiction():
    assert any(faults([0.0] * 40, straight(0.3)))
    assert set(faults([0.0] * 40, straight(0.3), sigma_m=0.06)) == {""}


def test_a_pose_beside_the_axle_moves_while_the_robot_turns():
    circle = [(0.4 * math.cos(0.1 * n), 0.4 * math.sin(0.1 * n)) for n in range(60)]
    assert set(faults([0.0] * 60, circle, omega=1.0)) == {""}
    assert any(faults([0.0] * 60, circle))


def test_wheels_that_slip_are_no_contradiction():
    assert set(faults([0.6] * 40, straight(0.0))) == {""}


def test_a_robot_without_velocity_commands_is_not_judged():
    assert set(faults([0.0] * 40, straight(0.45), fastest=None)) == {""}


def test_without_newer_poses_nothing_is_known():
    assert set(faults([0.0] * 40, straight(0.45), every=16)) == {""}
    found = faults([0.0] * 40, straight(0.45), until=13)
    assert any(found[10:17])
    assert set(found[18:]) == {""}
