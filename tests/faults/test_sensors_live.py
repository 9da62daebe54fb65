"""Sensors that freeze, slow down or are cut off: what the real executive does, at the guard's output."""

import random
import time

import pytest

from tests.support.bus_system import outputs
from tests.support.injection.proxied_robot import robot_in
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

STALE_S = 0.5
TICK_S = 0.1
HOLD_S = STALE_S + TICK_S + 0.05  # the tick that notices, and the way to the guard
SILENT_S = HOLD_S + 0.3 + TICK_S  # an executive that hears no driver sends nothing; then the guard's time-out counts
TRIES = [1, pytest.param(20, marks=pytest.mark.slow)]


@pytest.mark.promise("P6")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
def test_a_frozen_sensor_stops_the_robot_and_motion_goes_on_with_it(tmp_path, tries, measured):
    phases = random.Random(5)
    with robot_in(tmp_path) as robot:

        def frozen():
            robot.starts()
            time.sleep(phases.uniform(0.0, 0.1))
            since_s = time.monotonic()
            robot.sensors(odom=0)
            stop_s = robot.stopped_s(since_s) - since_s
            wait_until(robot.stands("input stale"), "hold")
            robot.sensors()
            wait_until(robot.moves, "motion goes on, without being armed again")
            assert stop_s > 0.3, "a pause of the sensor that is no fault must not stop the robot"
            assert stop_s <= HOLD_S
            return stop_s

        for _ in range(tries):
            measured.add(repeat_on_stall(3, frozen), HOLD_S, what="to zero")


@pytest.mark.promise("P21")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", [1, pytest.param(5, marks=pytest.mark.slow)])
def test_at_half_its_rate_a_sensor_starts_no_other_action(tmp_path, tries, measured):
    with robot_in(tmp_path) as robot:

        def halved():
            robot.starts()
            assert robot.status.action_index == 0
            robot.sensors(odom=25)
            wait_until(robot.stands("input slow"), "hold")
            assert (robot.status.mode, robot.status.action, robot.status.action_index) == ("HOLDING", "", 1)
            since_s = time.monotonic()
            time.sleep(2.0)
            started = [v for at, v in outputs(robot.trace) if at > since_s and v != 0.0]
            robot.sensors()
            wait_until(robot.moves, "motion goes on")
            assert robot.status.action_index == 1
            return len(started)

        for _ in range(tries):
            measured.add(repeat_on_stall(3, halved), 0, unit="set-points", what="while it stands")


@pytest.mark.promise("P12")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
def test_an_executive_that_hears_nothing_stops_the_robot(tmp_path, tries, measured):
    """One-way partition: its commands arrive, but no sensor and no driver state reach it."""
    phases = random.Random(6)
    with robot_in(tmp_path) as robot:

        def deaf():
            robot.proxy.block(False)
            robot.starts()
            time.sleep(phases.uniform(0.0, 0.1))
            since_s = time.monotonic()
            robot.proxy.block(to_router=False)
            stop_s = robot.stopped_s(since_s) - since_s
            assert stop_s <= SILENT_S
            return stop_s

        for _ in range(tries):
            measured.add(repeat_on_stall(3, deaf), SILENT_S, what="to zero")
