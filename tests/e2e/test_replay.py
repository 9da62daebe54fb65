"""Replay as people use it: keys in a terminal, a live driver on the bus, another executive in the old one's place."""

import os
import pty
import subprocess
import sys
import termios
import threading
import time
from dataclasses import replace

import pytest

from runtime.session import open_client, open_router
from schemas.messages import ArmRequest, DriverState, ExecStatus, Odometry, VelocityCommand
from schemas.own import example
from tests.e2e.bus_system import ROOT, bus_system, free_endpoint, wait_until
from tests.unit.test_comparison import Script

DRIVER, EXECUTIVE = "cd" * 16, "ab" * 16


@pytest.fixture
def recording(tmp_path):
    """Two seconds at 10 Hz: sensors, a driver that obeys EXECUTIVE, and its commands."""
    script = Script(tmp_path / "r.mcap")
    script.say(0, "agilo/arm_request", ArmRequest(True, False, "", 0))
    for tick in range(20):
        script.say(tick * 100, "agilo/odom", Odometry(0, tick / 10, 0.0, 0.0, 0.0, 0.0), DRIVER)
        armed = replace(example(DriverState), mode="armed", armed_sender=EXECUTIVE)
        script.say(tick * 100, "agilo/driver", armed, DRIVER)
        script.say(tick * 100, "agilo/cmd_vel", VelocityCommand(0, 0.5, 0.0))
    return script.close()


def command(path, endpoint, *options):
    return [sys.executable, "-m", "tools.main", "replay", path, "--connect", endpoint, "--wait", "0.2", *options]


def heard(session, names):
    """Starts to listen; returns a function that gives all samples so far."""
    inbox, samples = session.inbox(names, "agilo"), []

    def all_so_far():
        samples.extend(inbox.drain())
        return samples

    return all_so_far


def test_keys_step_pause_and_end_a_replay(recording):
    with bus_system() as (session, endpoint, _):
        odometry = heard(session, ["odom"])
        ours, theirs = pty.openpty()
        options = ("--paused", "--topics", "odom")
        player = subprocess.Popen(
            command(recording, endpoint, *options),
            stdin=theirs,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            cwd=ROOT,
            text=True,
        )
        wait_until(lambda: not termios.tcgetattr(theirs)[3] & termios.ICANON, 30.0, "single keys")
        time.sleep(0.3)
        assert odometry() == []
        for number in range(1, 4):
            os.write(ours, b"s")
            wait_until(lambda n=number: len(odometry()) == n, what=f"step {number}")
        time.sleep(0.3)
        assert len(odometry()) == 3
        os.write(ours, b" ")
        wait_until(lambda: odometry()[-1].sequence >= 8, what="going on")
        os.write(ours, b" ")
        time.sleep(0.3)
        paused_at = odometry()[-1].sequence
        time.sleep(0.4)
        assert odometry()[-1].sequence == paused_at < 20
        os.write(ours, b"q")
        assert player.wait(5.0) == 0
        assert "footer" not in player.stderr.read(), "what was not played is not damaged"
        os.close(ours)
        os.close(theirs)


def test_a_live_driver_is_not_sent_recorded_commands(recording, tmp_path):
    with bus_system() as (session, endpoint, start):
        start("tests.e2e.stand_in_sim", endpoint, tmp_path / "trace")
        wait_until(session.inbox(["driver"], "agilo").drain, what="driver state")
        commands = heard(session, ["cmd_vel", "arm_request"])
        said = subprocess.run(
            command(recording, endpoint, "--rate", "8"),
            capture_output=True,
            text=True,
            timeout=30,
            cwd=ROOT,
            check=True,
        )
        assert commands() == []
        assert "a driver is live" in said.stderr
        subprocess.run(command(recording, endpoint, "--drive", "--rate", "8"), timeout=30, cwd=ROOT, check=True)
        wait_until(commands, what="commands of --drive")


def test_a_substitute_executive_hears_the_sensors_and_a_driver_that_obeys_it(recording):
    with bus_system() as (session, endpoint, _), open_client(endpoint) as live:
        over = threading.Event()

        def executive():
            status = live.publisher("status", "")
            while not over.wait(0.05):
                status.publish(example(ExecStatus))

        thread = threading.Thread(target=executive)
        thread.start()
        driver, commands = heard(session, ["driver", "odom"]), heard(session, ["cmd_vel", "arm_request"])
        try:
            options = ("--substitute", "executive", "--rate", "4")
            subprocess.run(command(recording, endpoint, *options), timeout=30, cwd=ROOT, check=True)
        finally:
            over.set()
            thread.join()
        states = [s.message for s in driver() if isinstance(s.message, DriverState)]
        assert {state.armed_sender for state in states} == {live.sender}
        assert any(isinstance(s.message, Odometry) for s in driver())
        assert commands() == []


def test_the_clock_of_a_replay_tells_recorded_time(recording):
    with bus_system() as (session, endpoint, _):
        clock = heard(session, ["clock"])
        options = ("--clock", "50", "--rate", "2", "--start", "1.0")
        player = subprocess.Popen(command(recording, endpoint, *options), cwd=ROOT)
        wait_until(lambda: clock() and player.poll() is not None, what="end of the replay")
        times = [s.message.stamp_ns / 1e9 - 1_700_000_000 for s in clock()]
        assert times == sorted(times)
        assert 0.99 < times[0] < 1.1
        assert 1.8 < times[-1] < 2.0
        assert len(times) > 15


def test_a_replay_ends_when_the_bus_goes_away(recording):
    endpoint = free_endpoint()
    with open_router(endpoint) as session:
        odometry = heard(session, ["odom"])
        player = subprocess.Popen(
            command(recording, endpoint, "--loop"),
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
        )
        wait_until(odometry, 30.0, "the first message")
    said = player.communicate(timeout=20)[1]
    assert (player.returncode, said.splitlines()[-1]) == (1, "the bus is gone: the replay ended early")
