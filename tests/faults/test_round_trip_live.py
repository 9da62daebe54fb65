"""Delays that the guard cannot see: of driver states and sensors, or there already when the robot was armed.

The real executive notices them by its own clock: the driver's state echoes the stamp of its newest command.
"""

import random
import time

import pytest

from tests.support.bus_system import outputs
from tests.support.injection.proxied_robot import robot_in
from tests.support.stalls import repeat_on_stall

RAMP_S_PER_S = 0.2
TRIES = [1, pytest.param(20, marks=pytest.mark.slow)]
LATE = {"driver states": (0.0, 0.8), "commands": (0.8, 0.0), "both": (0.8, 0.8)}  # seconds; to and from the driver
SETTLE_S = 3.0  # the last commands before the echo was too old have arrived
IN_TIME = {"both": (0.25, 0.25), "driver states": (0.0, 0.6)}


def first_fast(ways):
    """One way among the fast tests, the others among the slow ones: the delays grow for seven seconds in each."""
    first, *others = ways
    return pytest.mark.parametrize("way", [first, *(pytest.param(way, marks=pytest.mark.slow) for way in others)])


def creeps_up(robot, delays_s):
    """The delays grow to `delays_s` and stay; people arm the robot again whenever the guard has stopped it."""
    began_s, grown_s = time.monotonic(), 0.0
    while grown_s < max(delays_s) + SETTLE_S * RAMP_S_PER_S:
        grown_s = RAMP_S_PER_S * (time.monotonic() - began_s)
        for direction, delay_s in zip((robot.proxy.to_router, robot.proxy.from_router), delays_s, strict=True):
            direction.delay_s = min(delay_s, grown_s)
        robot.arms()
        time.sleep(0.01)


def set_points(robot, duration_s):
    """Set-points of the guard in the next `duration_s`, and the one before."""
    since_s, before = time.monotonic(), outputs(robot.trace)[-1][1]
    time.sleep(duration_s)
    return [before, *(v for at, v in outputs(robot.trace) if at > since_s)]


@pytest.mark.promise("P13")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
@first_fast(LATE)
def test_at_a_delay_of_800_ms_the_robot_stands_although_it_is_armed(tmp_path, way, tries, measured):
    phases = random.Random(9)
    with robot_in(tmp_path) as robot:

        def delayed():
            robot.proxy.delay(0.0)
            robot.starts()
            time.sleep(phases.uniform(0.0, 0.1))
            creeps_up(robot, LATE[way])
            moved = sum(v != 0.0 for v in set_points(robot, 2.0))
            assert robot.poll().mode == "HOLDING", "by the executive, which is armed"
            assert moved == 0
            return moved

        for _ in range(tries):
            measured.add(repeat_on_stall(3, delayed), 0, unit="set-points", what="while it stands")


@pytest.mark.promise("P13")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize("tries", TRIES)
@first_fast(IN_TIME)
def test_a_round_trip_of_600_ms_holds_up_nobody(tmp_path, way, tries):
    with robot_in(tmp_path) as robot:

        def driven():
            robot.proxy.delay(0.0)
            robot.starts()
            creeps_up(robot, IN_TIME[way])
            assert all(set_points(robot, 1.5))

        for _ in range(tries):
            repeat_on_stall(3, driven)
