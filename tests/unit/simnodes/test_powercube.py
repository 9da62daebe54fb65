"""The arm's body: repeatable, within its limits for any command, measured by its sensors."""

import hashlib
import subprocess
import sys

import numpy as np
import pytest

from tailor.simnodes.powercube.body import PowerCubeBody
from tailor.simnodes.powercube.motor import PERIOD_S, Motor
from tailor.simnodes.powercube.physical_parameters import NAMES, PhysicalParameters
from tests.support.cpu_time import min_cpu_s

TICK_NS = 100_000_000


def body(seed=0, **start):
    made = PowerCubeBody()
    made.reset(np.random.default_rng(seed), start)
    return made


def follow(made, commands):
    readings = []
    for command in commands:
        made.command(command)
        readings += made.advance(TICK_NS)
    return readings


def scribble(seed, ticks=30):
    return [tuple(row) for row in np.random.default_rng(seed).uniform(-0.8, 0.8, (ticks, 2)).cumsum(0) * 0.2]


def fingerprint(seed):
    readings = follow(body(seed, a=0.3, wb=0.2), scribble(seed))
    return hashlib.sha256(repr(readings).encode()).hexdigest()


def test_same_seed_and_commands_give_the_same_readings_in_two_processes():
    code = "from tests.unit.simnodes.test_powercube import fingerprint; print(fingerprint(7))"
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()
    assert fingerprint(7) == other
    assert fingerprint(8) != other


def test_advancing_in_pieces_is_advancing_at_once():
    once, pieces = body(3, b=0.4), body(3, b=0.4)
    once.command((0.4, -0.3))
    pieces.command((0.4, -0.3))
    whole = once.advance(TICK_NS)
    assert [reading for _ in range(20) for reading in pieces.advance(TICK_NS // 20)] == whole


def test_the_arm_holds_still_without_sagging():
    made = body(a=0.5, b=-0.4)
    follow(made, [(0.0, 0.0)] * 20)
    _, _, *rest = made.ground_truth().positions
    assert made.ground_truth().positions[:2] == pytest.approx((0.5, -0.4), abs=1e-3)
    assert np.isfinite(rest).all()


def test_set_points_are_followed_within_three_hundredths():
    made = body()
    follow(made, [(0.05 * k, -0.05 * k) for k in range(11)])
    for _ in range(5):
        follow(made, [(0.5, -0.5)])
        assert made.ground_truth().velocities[:2] == pytest.approx((0.5, -0.5), abs=0.03)


@pytest.mark.parametrize("command", [(1e9, -1e9), (-1e9, 1e9)])
def test_no_command_breaks_a_limit(command):
    made, limits = body(), PhysicalParameters()
    made.command(command)
    for _ in range(60):
        made.advance(TICK_NS)
        state = made.ground_truth()
        assert np.abs(state.positions[:2]).max() < limits.position_max_rad + 0.02
        assert np.abs(state.velocities[:2]).max() < limits.velocity_max_radps + 0.05


def test_a_motor_never_takes_more_than_its_current_limit():
    limits = PhysicalParameters()
    motor = Motor(limits)
    motor.accept(1.0)
    taken = [motor.tick(0.0) for _ in range(1000)]  # jammed
    assert max(taken) == limits.current_max_a
    motor.accept(-1.0)
    back = [motor.tick(0.0) for _ in range(600)]
    assert min(back) < 0.0, "it does not work off a second of jam first"


def test_a_motor_ramps_its_set_point_within_the_acceleration_limit():
    limits = PhysicalParameters()
    motor = Motor(limits)
    motor.accept(1.2)
    speeds = []
    for _ in range(600):
        motor.tick(0.0)
        speeds.append(motor.velocity)
    assert np.diff(speeds).max() <= limits.acceleration_max_radps2 * PERIOD_S + 1e-12
    assert speeds[-1] == 1.2


def test_encoders_measure_whole_counts_of_all_six_joints():
    readings = follow(body(2), [(0.3, 0.2)] * 5)
    states = [reading.message for reading in readings if reading.topic == "joint_states"]
    count = PhysicalParameters().count_rad
    assert len(states) == 25
    for state in states:
        assert state.names == NAMES
        counts = np.array(state.positions) / count
        assert counts == pytest.approx(np.round(counts), abs=1e-6)


def test_currents_include_the_peak_since_the_last_message():
    readings = follow(body(), [(0.0, 0.0)] * 3 + [(0.0, 0.7)] + [(0.0, 0.7)] * 6)
    currents = [reading.message for reading in readings if reading.topic == "currents"]
    assert max(message.peak_amperes[1] for message in currents) > 1.2 * currents[-1].amperes[1]


@pytest.mark.slow
def test_the_arm_runs_fifty_times_faster_than_real_time():
    made = body()
    made.command((0.2, 0.1))
    assert min_cpu_s(lambda: made.advance(5_000_000_000)) < 5.0 / 50


def test_repeating_a_set_point_changes_nothing():
    once, often = body(), body()
    once.command((0.4, -0.3))
    expected = once.advance(TICK_NS)
    repeated = []
    for _ in range(10):
        often.command((0.4, -0.3))
        repeated += often.advance(TICK_NS // 10)
    assert repeated == expected


def test_a_motor_turns_round_after_it_was_braked_at_the_end_of_its_range():
    made = body(a=1.8)
    follow(made, [(1.2, 0.0)] * 20 + [(1.1, 0.0)] * 5 + [(-0.5, 0.0)] * 10)
    assert made.ground_truth().velocities[0] == pytest.approx(-0.5, abs=0.03)
