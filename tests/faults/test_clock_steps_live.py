"""Steps of the wall clock, in all processes of a robot that moves: nobody stops, and its recording verifies."""

import math
import subprocess
import time

import pytest

from tailor.runtime.processes.child import tailor
from tailor.schemas.messages import DriverState
from tests.faults.supervision.launched import launched
from tests.support.injection.wall_clock import WallClock
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

BEYOND_ROS_S = 86400.0 * 365 * 20  # after 2038 stamps begin again
STEPS_S = (3600.0, -3600.0, 0.5, -0.5, 86400.0 * 365, BEYOND_ROS_S, 0.0)
RANGE_S = 2.0**31  # of ROS's stamps
AFTER_S = 1.0  # the executive holds after 0.5 s without fresh data, the guard stops after 0.3 s without a command


def state_of(system):
    return wait_until(lambda: system.poll().get(DriverState), "driver")


def off_s(system, seconds):
    """How far the driver's clock is from a step of the true one."""
    return abs(math.remainder(state_of(system).stamp_ns / 1e9 - time.time() - seconds, RANGE_S))


def goes_on(system, clock, seconds):
    """After a step the robot moves on, armed: its stops would last until people arm it."""
    before_s = off_s(system, seconds)
    clock.step_to(seconds)
    ends_s = time.monotonic() + AFTER_S
    while time.monotonic() < ends_s:
        assert (state_of(system).mode, state_of(system).reason) == ("armed", ""), seconds
        time.sleep(0.02)
    assert off_s(system, seconds) < 0.4 < before_s, "the driver's clock was stepped"
    wait_until(system.moves, "robot moves on")


def driven_over_steps(clock, folder, start_s, steps_s):
    folder.mkdir(exist_ok=True)
    clock.step_to(start_s)
    with launched(folder) as system:
        wait_until(system.moves, "robot moves")
        for seconds in steps_s:
            goes_on(system, clock, seconds)
        recording = system.recording
    done = subprocess.run(tailor("verify", str(recording)), capture_output=True, text=True)
    assert (done.returncode, done.stdout[:6]) == (0, "equal:"), (done.stdout, done.stderr)


@pytest.mark.promise("P22")
@pytest.mark.slow
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize(("start_s", "steps_s"), [(0.0, STEPS_S), (BEYOND_ROS_S, (0.0,))])
def test_steps_of_the_wall_clock_stop_nobody_and_the_recording_verifies(tmp_path, monkeypatch, start_s, steps_s):
    clock = WallClock(tmp_path, monkeypatch)
    folders = (tmp_path / f"attempt-{number}" for number in range(3))
    repeat_on_stall(3, lambda: driven_over_steps(clock, next(folders), start_s, steps_s))
