"""Services of a running simulator, over the bus."""

import json
import time

import pytest

from tests.support.bus_system import driving, guarded_robot, moving, outputs
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall


@pytest.fixture
def system(tmp_path):
    with guarded_robot(tmp_path) as robot:
        yield robot


def call(session, name, what):
    return session.call(f"agilo/sim/{name}", json.dumps(what))


def newest(inbox):
    return wait_until(inbox.drain, "a message")[-1].message


def test_reset_puts_the_world_back_and_disarms(system):
    session, endpoint, start, trace = system
    truth, driver = session.inbox(["truth"], "agilo"), session.inbox(["driver"], "agilo")
    driving(start, endpoint, trace)
    wait_until(lambda: newest(truth).x > 0.1, "robot moves")
    assert call(session, "reset", {"start": {"x": -3.0}}) == (True, "reset")
    wait_until(lambda: newest(truth).x == -3.0, "robot back at its start")
    wait_until(lambda: newest(driver).reason == "the world was reset", "disarmed")
    time.sleep(0.3)
    assert outputs(trace)[-1][1] == 0.0
    assert newest(truth).x == -3.0


def test_in_a_pause_nothing_moves_and_steps_are_exact(system):
    session, *_ = system
    odometry = session.inbox(["odom"], "agilo")
    assert call(session, "step", 1) == (False, "step: pause first")
    latest = wait_until(odometry.drain)
    assert call(session, "pause", True) == (True, "paused")

    def sequence():
        nonlocal latest
        latest = odometry.drain() or latest
        return latest[-1].sequence

    def stands_still():
        before = sequence()
        time.sleep(0.3)
        return sequence() == before

    wait_until(stands_still, "silence of a paused world")
    before = sequence()
    assert call(session, "step", 50) == (True, "50 periods")  # of 10 ms; odometry comes every 20 ms
    wait_until(lambda: sequence() == before + 25, "odometry of 50 periods")
    assert call(session, "step", 2)[0]
    wait_until(lambda: sequence() == before + 26, "odometry of two more")
    assert call(session, "pause", False) == (True, "running")
    wait_until(lambda: sequence() > before + 26, "a running world")


def test_a_pause_of_the_world_does_not_count_as_silence_of_the_executive(system):
    session, endpoint, start, trace = system
    truth = session.inbox(["truth"], "agilo")

    def drives_on():
        executive = driving(start, endpoint, trace)
        call(session, "pause", True)
        time.sleep(1.0)
        truth.drain()
        call(session, "pause", False)
        first = newest(truth)
        time.sleep(0.3)
        speed, last = outputs(trace)[-1][1], newest(truth)
        executive.kill()
        wait_until(moving(trace, 0.0), "robot at rest")
        assert speed == 0.5
        assert last.x > first.x

    repeat_on_stall(3, drives_on)


def test_things_can_be_placed_while_the_world_runs(system):
    session, *_ = system
    truth = session.inbox(["truth"], "agilo")
    assert call(session, "place", {"ball_x": 4.5}) == (True, "placed")
    wait_until(lambda: newest(truth).ball_x == 4.5, "ball placed")
    assert call(session, "place", {"ball_x": "far"})[0] is False
    for huge in (1e308, -1001.0, 10**400):
        assert "expected an object of numbers up to 1000" in call(session, "place", {"x": huge})[1]
    assert call(session, "place", {"ball": 1.0}) == (
        False,
        "place: unknown name ball, expected some of: x, y, phi, ball_x, ball_y",
    )
    assert "unknown name z" in call(session, "reset", {"start": {"z": 1.0}})[1]
