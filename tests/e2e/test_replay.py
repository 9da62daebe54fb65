"""Replay: keys in a terminal, a live driver on the bus, a substitute for the recorded executive."""

import os
import pty
import signal
import subprocess
import sys
import termios
import threading
import time
from contextlib import contextmanager
from dataclasses import replace

import pytest

from tailor.runtime.bus.opening import open_client, open_router
from tailor.schemas.codec import decode
from tailor.schemas.messages import ArmRequest, Clock, DriverState, ExecStatus, Odometry, VelocityCommand
from tailor.schemas.own import example
from tailor.tools.operator.stop_button import StopButton
from tests.support.bus_system import ROOT, bus_system, free_endpoint, secured_system
from tests.support.patience import PATIENCE_S, wait_until
from tests.support.stalls import repeat_on_stall
from tests.unit.tools.test_comparison import Script

DRIVER, EXECUTIVE = "cd" * 16, "ab" * 16


def recorded(path, ticks, mode="armed"):
    """A run at 10 Hz: sensors, a driver in a mode that obeys EXECUTIVE, and its commands."""
    script = Script(path)
    script.say(0, "agilo/arm_request", ArmRequest(True, False, "", 0))
    for tick in range(ticks):
        script.say(tick * 100, "agilo/odom", Odometry(0, tick / 10, 0.0, 0.0, 0.0, 0.0), DRIVER)
        armed = replace(example(DriverState), mode=mode, armed_sender=EXECUTIVE, command_stamp_ns=1 + tick)
        script.say(tick * 100, "agilo/driver", armed, DRIVER)
        script.say(tick * 100, "agilo/cmd_vel", VelocityCommand(0, 0.5, 0.0))
    return script.close()


@pytest.fixture
def recording(tmp_path):
    """Two seconds of it."""
    return recorded(tmp_path / "r.mcap", 20)


def command(path, endpoint, *options):
    return [
        sys.executable,
        "-P",
        "-m",
        "tailor.tools.main",
        "replay",
        path,
        "--connect",
        endpoint,
        "--wait",
        "1.0",
        *options,
    ]


def run(*words):
    """Run a replay to its end; the result holds stderr."""
    return subprocess.run(command(*words), capture_output=True, text=True, timeout=PATIENCE_S, cwd=ROOT, check=True)


def collect(session, names):
    """Starts to listen; returns a function that gives all samples so far."""
    inbox, samples = session.inbox(names, "agilo"), []

    def all_so_far():
        samples.extend(inbox.drain())
        return samples

    return all_so_far


@contextmanager
def player_with_keys(*words):
    """A replay in a terminal of its own: the process, and the end of the terminal that keys go into."""
    ours, theirs = pty.openpty()
    player = subprocess.Popen(
        command(*words), stdin=theirs, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, cwd=ROOT, text=True
    )
    try:
        wait_until(lambda: not termios.tcgetattr(theirs)[3] & termios.ICANON, "single keys")
        yield player, ours
    finally:
        player.kill()
        player.communicate()
        os.close(ours)
        os.close(theirs)


def test_keys_step_pause_and_end_a_replay(tmp_path):
    ticks = 600  # a minute: it must not be over before it is paused
    with bus_system() as (session, endpoint, _):
        odometry = collect(session, ["odom"])
        recording = recorded(tmp_path / "long.mcap", ticks)
        with player_with_keys(recording, endpoint, "--paused", "--topics", "odom") as (player, keys):
            time.sleep(0.3)
            assert odometry() == []
            for number in range(1, 4):
                os.write(keys, b"s")
                wait_until(lambda n=number: len(odometry()) == n, f"step {number}")
            time.sleep(0.3)
            assert len(odometry()) == 3
            os.write(keys, b" ")
            wait_until(lambda: odometry()[-1].sequence >= 8, "going on")
            os.write(keys, b" ")

            def stands_still():
                before = odometry()[-1].sequence
                time.sleep(0.4)
                return odometry()[-1].sequence == before

            wait_until(stands_still, "a pause")
            assert odometry()[-1].sequence < ticks
            os.write(keys, b"q")
            assert player.wait(PATIENCE_S) == 0
            assert "footer" not in player.stderr.read(), "what was not played is not damaged"


def test_a_repetition_is_played_as_the_keys_have_it(recording):
    """Each round began paused again, and at the first rate."""
    with bus_system() as (session, endpoint, _):
        odometry = collect(session, ["odom"])
        options = ("--paused", "--loop", "--rate", "20", "--topics", "odom")
        with player_with_keys(recording, endpoint, *options) as (_, keys):
            os.write(keys, b" ")
            wait_until(lambda: [sample.sequence for sample in odometry()].count(20) == 3, "the third round")


@pytest.mark.parametrize("options", [(), ("--substitute", "executive")], ids=["subscribers", "an executive"])
def test_ctrl_c_ends_a_replay_that_waits_for(options, recording):
    with bus_system() as (_, endpoint, _):
        player = subprocess.Popen(command(recording, endpoint, "--wait", "1000", *options), cwd=ROOT)
        try:
            time.sleep(2.0)
            player.send_signal(signal.SIGINT)
            assert player.wait(5.0) in (130, -signal.SIGINT), "the latter where a busy machine has not loaded it yet"
        finally:
            player.kill()
            player.wait(PATIENCE_S)


@pytest.mark.promise("P14")
def test_recorded_commands_are_not_published_to_a_live_driver(recording, tmp_path):
    with bus_system() as (session, endpoint, start):
        start("tests.support.stand_ins.sim", endpoint, tmp_path / "trace")
        wait_until(session.inbox(["driver"], "agilo").drain, "driver state")

        def spared():
            commands, states = collect(session, ["cmd_vel", "arm_request"]), collect(session, ["driver"])
            errors = run(recording, endpoint, "--rate", "8").stderr
            assert "a driver is live" in errors  # the driver is live unless its simulator stalls for half a second
            assert commands() == []
            assert DRIVER not in {sample.sender for sample in states()}

        repeat_on_stall(3, spared)
        commands = collect(session, ["cmd_vel", "arm_request"])
        run(recording, endpoint, "--drive", "--rate", "8")
        wait_until(commands, "commands of --drive")


@pytest.mark.promise("P16")
def test_on_a_secured_bus_no_recording_confirms_an_estop(tmp_path):
    stopped = recorded(tmp_path / "stopped.mcap", 20, mode="estopped")
    with secured_system() as (session, endpoint, _), open_client(endpoint, role="people") as people:
        odometry = collect(session, ["odom"])
        player = subprocess.Popen(command(stopped, endpoint, "--loop"), stderr=subprocess.PIPE, text=True, cwd=ROOT)
        try:
            wait_until(odometry, "the replay")
            assert StopButton(people).press() == {}
            assert player.poll() is None, "the replay goes on"
        finally:
            player.kill()
            errors = player.communicate()[1]
        assert "the bus is secured" in errors


def test_on_a_secured_bus_nothing_is_substituted(recording):
    with secured_system() as (_, endpoint, _):
        done = subprocess.run(
            command(recording, endpoint, "--substitute", "executive"),
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
        )
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "--substitute executive" in done.stderr
    assert "--security open" in done.stderr


def test_a_substitute_executive_receives_the_sensors_and_a_driver_that_obeys_it(recording):
    with bus_system() as (session, endpoint, _), open_client(endpoint) as live:
        over = threading.Event()

        def executive():
            status = live.publisher("status", "")
            while not over.wait(0.05):
                status.publish(example(ExecStatus))

        thread = threading.Thread(target=executive)
        thread.start()
        driver, commands = collect(session, ["driver", "odom"]), collect(session, ["cmd_vel", "arm_request"])
        try:
            run(recording, endpoint, "--substitute", "executive", "--rate", "4")
        finally:
            over.set()
            thread.join()
        states = [s.message for s in driver() if isinstance(s.message, DriverState)]
        assert {state.armed_sender for state in states} == {live.sender}
        assert {state.command_stamp_ns for state in states} == {0}, "a recorded echo is minutes old to a live executive"
        assert any(isinstance(s.message, Odometry) for s in driver())
        assert commands() == []


def test_the_clock_of_a_replay_publishes_recorded_time(recording):
    with bus_system() as (session, endpoint, _):
        queue, tapped = session.subscribe_all("clock")  # all of them: an inbox keeps the newest alone
        run(recording, endpoint, "--clock", "50", "--rate", "0.5", "--start", "1.0")
        raws = wait_until(queue.drain, "the clock")
        times = [decode(Clock, raw.payload).stamp_ns / 1e9 - 1_700_000_000 for raw in raws]
        tapped.undeclare()
        assert times == sorted(times)
        assert 0.99 < times[0] < 1.3
        assert 1.6 < times[-1] < 2.0
        assert 15 < len(times) < 150, "fifty in each of two seconds, but for what a busy machine skips"


def test_a_replay_ends_when_the_bus_disconnects(recording):
    endpoint = free_endpoint()
    with open_router(endpoint) as session:
        odometry = collect(session, ["odom"])
        player = subprocess.Popen(
            command(recording, endpoint, "--loop"),
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
        )
        wait_until(odometry, "the first message")
    errors = player.communicate(timeout=PATIENCE_S)[1]
    assert (player.returncode, errors.splitlines()[-1]) == (1, "bus disconnected: the replay ended early")
