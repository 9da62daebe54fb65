"""What people may ask of a running simulator, over the bus."""

import json
import time

import pytest

from tests.e2e.bus_system import bus_system, wait_until
from tests.e2e.test_guard_stops import EXECUTIVE, moving, outputs


@pytest.fixture
def system(tmp_path):
    with bus_system() as (session, endpoint, start):
        trace = tmp_path / "trace"
        start("tests.e2e.stand_in_sim", endpoint, trace)
        wait_until(session.inbox(["driver"], "agilo").drain, what="driver state")
        yield session, endpoint, start, trace


def ask(session, name, what):
    return session.ask(f"agilo/sim/{name}", json.dumps(what))


def newest(inbox, timeout_s=2.0):
    return wait_until(inbox.drain, timeout_s)[-1].message


def test_reset_puts_the_world_back_and_disarms(system):
    session, endpoint, start, trace = system
    truth, driver = session.inbox(["truth"], "agilo"), session.inbox(["driver"], "agilo")
    start(EXECUTIVE, endpoint, 0.5)
    wait_until(moving(trace, 0.5), what="robot moves")
    time.sleep(0.5)
    assert newest(truth).x > 0.1
    assert ask(session, "reset", {"start": {"x": -3.0}}) == (True, "reset")
    wait_until(lambda: newest(truth).x == -3.0, what="robot back at its start")
    wait_until(lambda: newest(driver).reason == "the world was reset", what="disarmed")
    time.sleep(0.3)
    assert outputs(trace)[-1][1] == 0.0
    assert newest(truth).x == -3.0


def test_in_a_pause_nothing_moves_and_steps_are_exact(system):
    session, *_ = system
    odometry = session.inbox(["odom"], "agilo")
    assert ask(session, "step", 1) == (False, "step: pause first")
    first = wait_until(odometry.drain)
    assert ask(session, "pause", True) == (True, "paused")
    time.sleep(0.2)
    before = (odometry.drain() or first)[-1].sequence
    time.sleep(0.3)
    assert odometry.drain() == ()
    assert ask(session, "step", 50) == (True, "50 periods")  # of 10 ms; odometry comes every 20 ms
    wait_until(lambda: newest(odometry) and True)
    time.sleep(0.2)
    assert ask(session, "step", 2)[0]
    assert wait_until(odometry.drain)[-1].sequence == before + 26
    assert ask(session, "pause", False) == (True, "running")
    assert wait_until(odometry.drain)


def test_a_pause_of_the_world_is_no_silence_of_the_executive(system):
    session, endpoint, start, trace = system
    start(EXECUTIVE, endpoint, 0.5)
    wait_until(moving(trace, 0.5), what="robot moves")
    truth = session.inbox(["truth"], "agilo")
    ask(session, "pause", True)
    time.sleep(1.0)
    truth.drain()
    ask(session, "pause", False)
    first = newest(truth)
    time.sleep(0.3)
    assert outputs(trace)[-1][1] == 0.5
    assert newest(truth).x > first.x


def test_things_can_be_placed_while_the_world_runs(system):
    session, *_ = system
    truth = session.inbox(["truth"], "agilo")
    assert ask(session, "place", {"ball_x": 4.5}) == (True, "placed")
    wait_until(lambda: newest(truth).ball_x == 4.5, what="ball placed")
    assert ask(session, "place", {"ball_x": "far"})[0] is False
