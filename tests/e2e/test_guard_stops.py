"""Real processes on a real bus: whatever happens to the executive, the guard brings the robot to rest."""

import os
import random
import signal
import time
from functools import partial

import pytest

from tailor.schemas.messages import DriverState
from tests.support.bus_system import driving, guarded_robot, moving, outputs, zero_at
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

LIMIT_S = 0.3 + 0.1  # the guard's time-out and one period of the executive


@pytest.fixture
def system(tmp_path):
    with guarded_robot(tmp_path) as robot:
        yield robot


def rest_after(trace, since_s):
    """When the robot came to rest, monotonic s."""
    return wait_until(lambda: zero_at(trace, since_s), "robot at rest")


def killed_in_motion(start, endpoint, trace, after_s):
    """Kills a driving executive; seconds to zero at the guard, which are between the bounds whatever stalls."""
    executive = driving(start, endpoint, trace)
    time.sleep(after_s)
    assert moving(trace, 0.5)(), "the machine stalled the executive for 0.3 s"
    before_s = time.monotonic()
    executive.kill()
    killed_s = time.monotonic()
    at_rest_s = rest_after(trace, before_s)
    assert at_rest_s - killed_s <= LIMIT_S
    assert at_rest_s - before_s > 0.15, "a lost command must not stop the robot"
    return at_rest_s - killed_s


@pytest.mark.promise("P1")
@pytest.mark.parametrize("kills", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_robot_stops_within_300_ms_after_executive_is_killed(system, kills, measured):
    _, endpoint, start, trace = system
    phases = random.Random(1)
    for _ in range(kills):
        killed = partial(killed_in_motion, start, endpoint, trace, phases.uniform(0.15, 0.35))
        measured.add(repeat_on_stall(3, killed), LIMIT_S)


def hung_in_motion(start, endpoint, trace, after_s):
    """Hangs a driving executive; seconds to zero at the guard."""
    executive = driving(start, endpoint, trace)
    time.sleep(after_s)
    assert moving(trace, 0.5)(), "the machine stalled the executive for 0.3 s"
    hung_s = time.monotonic()
    os.kill(executive.pid, signal.SIGUSR1)
    stop_s = rest_after(trace, hung_s) - hung_s
    time.sleep(0.5)
    alive = executive.exit_code() is None
    executive.kill()
    assert alive, "it hangs, it is not dead"
    assert outputs(trace)[-1][1] == 0.0
    assert stop_s <= LIMIT_S
    return stop_s


@pytest.mark.promise("P1")
@pytest.mark.parametrize("hangs", [1, pytest.param(20, marks=pytest.mark.slow)])
def test_robot_stops_when_the_executive_hangs_and_its_bus_session_lives_on(system, hangs, measured):
    _, endpoint, start, trace = system
    phases = random.Random(2)
    for _ in range(hangs):
        hung = partial(hung_in_motion, start, endpoint, trace, phases.uniform(0.15, 0.35))
        measured.add(repeat_on_stall(3, hung), LIMIT_S)


@pytest.mark.promise("P1")
def test_a_pause_of_a_tick_does_not_stop_the_robot(system):
    _session, endpoint, start, trace = system

    def survived():
        executive = driving(start, endpoint, trace)
        began_s = time.monotonic()
        os.kill(executive.pid, signal.SIGSTOP)
        time.sleep(0.12)
        os.kill(executive.pid, signal.SIGCONT)
        time.sleep(0.5)
        stopped_s = zero_at(trace, began_s)
        executive.kill()
        rest_after(trace, began_s)
        assert stopped_s is None

    repeat_on_stall(5, survived)


@pytest.mark.promise("P1")
def test_a_pause_of_two_seconds_stops_the_robot_for_good(system, measured):
    _session, endpoint, start, trace = system

    def stopped():
        executive = driving(start, endpoint, trace)
        before_s = time.monotonic()
        os.kill(executive.pid, signal.SIGSTOP)
        paused_s = time.monotonic()
        at_rest_s = rest_after(trace, before_s)
        time.sleep(1.5)
        os.kill(executive.pid, signal.SIGCONT)
        time.sleep(0.5)
        speed = outputs(trace)[-1][1]
        executive.kill()
        assert at_rest_s - paused_s <= LIMIT_S
        assert speed == 0.0, "no backlog is executed, and nobody armed again"
        return at_rest_s - paused_s

    measured.add(repeat_on_stall(3, stopped), LIMIT_S)


@pytest.mark.promise("P14")
def test_a_second_executive_cannot_move_the_robot(system):
    session, endpoint, start, trace = system

    def refused():
        began_s = time.monotonic()
        first = driving(start, endpoint, trace, 0.25)
        states = session.inbox(["driver"], "agilo")
        second = start("tests.support.stand_ins.executive", endpoint, 0.9)

        def refused_by_sender():
            found = [s.message for s in states.drain() if isinstance(s.message, DriverState)]
            return any("other sender" in m.refused_reasons for m in found)

        wait_until(refused_by_sender, "refusal of the second executive")
        time.sleep(0.5)
        speed = outputs(trace)[-1][1]
        second.kill()
        first.kill()
        wait_until(moving(trace, 0.0), "robot at rest")
        assert speed == 0.25, "the first one still drives"
        assert {v for at, v in outputs(trace) if at > began_s} <= {0.0, 0.25}

    repeat_on_stall(3, refused)
