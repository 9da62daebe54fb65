"""Two executives on one bus: nobody is armed by chance, and what drops goals or stops reaches everything."""

import subprocess
import threading
import time
from contextlib import contextmanager
from dataclasses import replace

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import tailor
from tailor.schemas.messages import ExecStatus
from tailor.schemas.own import example
from tests.support.bus_system import guarded_robot
from tests.support.patience import PATIENCE_S

SENDERS = {"1" * 32: "waypoints", "2" * 32: "dribble\x1b[1m"}


def told(endpoint, *words):
    return subprocess.run(
        tailor(*words, "--connect", endpoint),
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        stdin=subprocess.DEVNULL,
    )


@contextmanager
def executives(endpoint, senders, refusing=()):
    """Processes that publish a status at 10 Hz and answer requests for goals; yields the requests of each."""
    ended, requests = threading.Event(), {sender: [] for sender in senders}

    def serve(sender, scenario):
        with open_client(endpoint, role="executive", sender=sender) as session:
            statuses, goals = session.publisher("status", ""), session.service_server("exec/goal")
            while not ended.wait(0.1):
                statuses.publish(replace(example(ExecStatus), scenario=scenario, sender=sender))
                if (request := goals.poll()) is not None:
                    requests[sender].append(request.text)
                    (request.refuse if sender in refusing else request.accept)(f"by {sender[:2]}")

    threads = [threading.Thread(target=serve, args=each) for each in senders.items()]
    for thread in threads:
        thread.start()
    try:
        time.sleep(0.5)
        yield requests
    finally:
        ended.set()
        for thread in threads:
            thread.join()


@pytest.fixture
def robot(tmp_path):
    with guarded_robot(tmp_path) as (session, endpoint, _, _):
        yield session, endpoint


def test_no_driver_is_armed_for_one_of_two_executives_but_for_the_one_that_is_named(robot):
    session, endpoint = robot
    states = session.inbox(["driver"], "agilo")
    with executives(endpoint, SENDERS):
        done = told(endpoint, "arm", "agilo")
        assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1), done.stderr
        assert "2 executives are running, expected one or --sender" in done.stderr
        assert f"{'1' * 32} (waypoints), {'2' * 32} (dribble\\x1b[1m)" in done.stderr
        assert {s.message.mode for s in states.drain()} == {"disarmed"}
        done = told(endpoint, "arm", "agilo", "--sender", "2" * 32)
        assert (done.returncode, done.stdout) == (0, "agilo is armed\n"), done.stderr


def test_the_one_running_executive_is_armed(robot):
    _, endpoint = robot
    with executives(endpoint, {"1" * 32: "waypoints"}):
        done = told(endpoint, "arm", "agilo")
    assert (done.returncode, done.stdout) == (0, "agilo is armed\n"), done.stderr


def test_disarming_stopping_and_dropping_goals_reach_all(robot):
    _, endpoint = robot
    with executives(endpoint, SENDERS) as requests:
        assert told(endpoint, "arm", "agilo", "--off").returncode == 0
        assert told(endpoint, "estop").returncode == 0
        done = told(endpoint, "goal", "--cancel")
        assert (done.returncode, sorted(done.stdout.splitlines())) == (0, ["by 11", "by 22"])
        assert "2 executives answered, expected one" in done.stderr
    assert list(requests.values()) == [["(and)"], ["(and)"]]


def test_a_goal_that_one_accepts_and_another_refuses_is_told_in_one_line(robot):
    _, endpoint = robot
    with executives(endpoint, SENDERS, refusing=["2" * 32]):
        done = told(endpoint, "goal", "(and (visited way1))")
    assert (done.returncode, done.stdout) == (2, "by 11\n")
    split = "1 accepted it and 1 did not; `tailor status` names them"
    assert done.stderr.splitlines() == ["by 22", f"2 executives answered, expected one: {split}"]
