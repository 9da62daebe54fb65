"""`tailor status` of a real bus: one JSON object, the exit code, and the stop key in a terminal."""

from __future__ import annotations

import json
import os
import pty
import subprocess
from contextlib import contextmanager, suppress

import pytest

from tailor.runtime.bus.attachment import UNSIGNED
from tailor.runtime.processes.child import tailor
from tailor.schemas.messages import DriverState
from tests.support.bus_system import bus_system, driving, guarded_robot
from tests.support.patience import PATIENCE_S, wait_until

pytestmark = pytest.mark.xdist_group("systems")


def status(endpoint, *flags):
    command = tailor("status", "--connect", endpoint, *flags)
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)


def test_the_state_is_one_json_object_and_the_exit_code_is_its_verdict(tmp_path):
    with guarded_robot(tmp_path) as (_, endpoint, start, trace):
        driving(start, endpoint, trace)
        done = status(endpoint, "--json", "--seconds", "1")
    state = json.loads(done.stdout)
    assert done.stdout.count("\n") == 1
    (driver,) = state["drivers"]
    assert (driver["robot"], driver["mode"], driver["silent"]) == ("agilo", "armed", False)
    assert {topic["key"] for topic in state["topics"]} >= {"agilo/cmd_vel", "agilo/driver"}
    assert [problem["problem"] for problem in state["problems"]] == ["driver obeys unknown sender", "no executive"]
    assert (state["healthy"], done.returncode) == (False, 1), "the stand-in executive publishes commands alone"


def test_required_sensors_that_never_speak_are_named_while_the_executive_is_disarmed():
    with bus_system() as (session, endpoint, start):
        start("tailor.tools.main", "executive", "soccer", "--wait", "--connect", endpoint)
        wait_until(session.inbox(["provenance"], "").drain, "executive")
        done = status(endpoint, "--json")
    problems = [problem for problem in json.loads(done.stdout)["problems"] if problem["problem"] == "topic missing"]
    assert [problem["detail"].partition(",")[0] for problem in problems] == ["agilo/odom", "agilo/pose"]
    assert done.returncode == 1


def test_foreign_messages_are_counted_and_nothing_else_is_printed():
    with bus_system() as (session, endpoint, _):
        junk = session.player("someone/else", "std_msgs/msg/String")
        with subprocess.Popen(tailor("status", "--connect", endpoint, "--json"), stdout=subprocess.PIPE) as process:
            wait_until(junk.matched, "subscription")
            junk.put_raw(b"junk", UNSIGNED)
            state = json.loads(process.communicate(timeout=PATIENCE_S)[0])
    assert state["foreign"]["unknown"] == {"someone/else": 1}
    assert [problem["problem"] for problem in state["problems"]] == ["no driver", "no executive"]


@contextmanager
def in_a_terminal(*command):
    """Yields the terminal's end for us, while the command runs in it."""
    ours, theirs = pty.openpty()
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True) as process:
        os.close(theirs)
        try:
            yield ours, process
        finally:
            process.kill()
            os.close(ours)


def test_the_stop_key_of_the_live_view_stops_the_robot(tmp_path):
    with guarded_robot(tmp_path) as (session, endpoint, start, trace):
        driving(start, endpoint, trace)
        states = session.inbox(["driver"], "agilo")
        with in_a_terminal(*tailor("status", "--connect", endpoint)) as (terminal, process):
            wait_until(lambda: b"EMERGENCY STOP" in os.read(terminal, 65536), "live view")
            assert modes(states) == {"armed"}
            os.write(terminal, b"s")
            wait_until(lambda: "estopped" in modes(states), "e-stop")
            os.write(terminal, b"q")
            with suppress(OSError):  # the terminal's other end is closed with the process
                while os.read(terminal, 65536):
                    pass
            assert process.wait(PATIENCE_S) == 1


def modes(states):
    return {s.message.mode for s in states.drain() if isinstance(s.message, DriverState)}
