"""Steps of the wall clock, in all processes of a robot that moves: nobody stops, and its recording verifies."""

import subprocess
import time

import pytest

from tailor.runtime.processes.child import tailor
from tailor.schemas.messages import DriverState
from tests.faults.supervision.launched import launched
from tests.support.injection.wall_clock import WallClock
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

STEPS_S = (3600.0, -3600.0, 0.5, -0.5, 86400.0 * 365, 0.0)
AFTER_S = 1.0  # the executive holds after 0.5 s without fresh data, the guard stops after 0.3 s without a command


def state_of(system):
    return wait_until(lambda: system.poll().get(DriverState), "driver")


def goes_on(system, clock, seconds):
    """After a step the robot moves on, armed: its stops would last until people arm it."""
    before_s = state_of(system).stamp_ns / 1e9 - time.time()
    clock.step_to(seconds)
    ends_s = time.monotonic() + AFTER_S
    while time.monotonic() < ends_s:
        assert (state_of(system).mode, state_of(system).reason) == ("armed", ""), seconds
        time.sleep(0.02)
    ahead_s = state_of(system).stamp_ns / 1e9 - time.time()
    assert abs(ahead_s - seconds) < 0.4 < abs(ahead_s - before_s), "the driver's clock was stepped"
    wait_until(system.moves, "robot moves on")


def driven_over_steps(clock, folder):
    folder.mkdir(exist_ok=True)
    clock.step_to(0.0)
    with launched(folder) as system:
        wait_until(system.moves, "robot moves")
        for seconds in STEPS_S:
            goes_on(system, clock, seconds)
        recording = system.recording
    done = subprocess.run(tailor("verify", str(recording)), capture_output=True, text=True)
    assert (done.returncode, done.stdout[:6]) == (0, "equal:"), (done.stdout, done.stderr)


@pytest.mark.promise("P22")
@pytest.mark.slow
@pytest.mark.xdist_group("live")
def test_steps_of_the_wall_clock_stop_nobody_and_the_recording_verifies(tmp_path, monkeypatch):
    clock = WallClock(tmp_path, monkeypatch)
    folders = (tmp_path / f"attempt-{number}" for number in range(3))
    repeat_on_stall(3, lambda: driven_over_steps(clock, next(folders)))
