"""The arm's body: repeatable, within its limits for any command, measured by its sensors."""

import hashlib
import subprocess
import sys

import numpy as np
import pytest

from tailor.simnodes.powercube.body import PowerCubeBody
from tailor.simnodes.powercube.motor import PERIOD_S, Motor
from tailor.simnodes.powercube.physical_parameters import NAMES, PhysicalParameters
from tests.support.cpu_time import standard_cpu_s

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


def test_encoders_err_by_noise_backlash_and_jitter_and_not_more():
    made = body(5, b=-0.3)
    errors = []
    for command in [(0.5 * (-1) ** (k // 10), 0.2) for k in range(40)]:
        made.command(command)
        for _ in range(5):
            state = made.advance(TICK_NS // 5)[0].message
            errors.append(np.subtract(state.positions[:2], made.ground_truth().positions[:2]))
    limits = PhysicalParameters()
    assert 1e-4 < np.std(errors) < 1e-3
    assert np.mean(errors, axis=0)[1] == pytest.approx(0.5 * limits.backlash_rad, abs=1e-4), "the motor lifts, ahead"
    assert np.abs(errors).max() < 0.5 * limits.backlash_rad + 5 * np.hypot(limits.encoder_std_rad, 0.5e-3)


def test_the_motor_crosses_the_backlash_when_its_torque_turns_round():
    made = body(a=0.0)
    follow(made, [(0.3, 0.0)] * 10)
    forward = made.gears[0].ahead_rad
    follow(made, [(-0.3, 0.0)] * 10)
    half = 0.5 * PhysicalParameters().backlash_rad
    assert (forward, made.gears[0].ahead_rad) == (half, -half)
    assert made.gears[1].ahead_rad == half, "the lift always carries its load"


def current_a(made, speed):
    """Mean current of the pan at a constant speed."""
    follow(made, [(speed, 0.0)] * 10)
    readings = [reading.message for reading in follow(made, [(speed, 0.0)] * 10) if reading.topic == "currents"]
    return np.mean([message.amperes[0] for message in readings])


def test_cold_gears_take_more_current_and_the_faster_the_more():
    slow, fast = ([current_a(body(a=-1.5, ta=celsius), speed) for celsius in (15.0, 45.0)] for speed in (0.1, 0.8))
    assert slow[0] > 1.05 * slow[1]
    assert fast[0] > 1.5 * fast[1]


def test_a_loaded_gear_has_more_friction():
    gear = body().gears[0]
    assert gear.friction(25.0)[0] > 1.3 * gear.friction(0.0)[0]
    assert gear.friction(-25.0) == gear.friction(25.0)


def test_gears_warm_with_work_and_cool_with_time():
    made = body(ta=40.0, tb=25.0)
    follow(made, [(0.5, 0.0)] * 20 + [(-0.5, 0.0)] * 20)
    cooled, warmed = (gear.temperature_c for gear in made.gears)
    assert 0.005 < warmed - 25.0 < 0.2  # it holds the arm up
    assert -0.2 < cooled - 40.0 < -0.005


def test_temperatures_are_drawn_by_the_seed():
    drawn = [tuple(gear.temperature_c for gear in body(seed).gears) for seed in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    assert np.ptp([body(seed).gears[0].temperature_c for seed in range(20)]) > 10.0


def test_nothing_is_left_of_the_episode_before():
    fresh, used = body(9), body(3, ta=60.0, tb=60.0, b=1.0)
    follow(used, [(0.6, -0.6)] * 10)
    used.reset(np.random.default_rng(9), {})
    assert follow(fresh, scribble(1)) == follow(used, scribble(1))


def test_currents_include_the_peak_since_the_last_message():
    readings = follow(body(), [(0.0, 0.0)] * 3 + [(0.0, 0.7)] + [(0.0, 0.7)] * 6)
    currents = [reading.message for reading in readings if reading.topic == "currents"]
    assert max(message.peak_amperes[1] for message in currents) > 1.2 * currents[-1].amperes[1]


@pytest.mark.slow
def test_the_arm_runs_fifty_times_faster_than_real_time():
    made = body()
    made.command((0.2, 0.1))
    assert standard_cpu_s(lambda: made.advance(20_000_000_000)) < 20.0 / 50


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
