"""How people stop a robot, from the shell or the live page to zero at the guard."""

import json
import os
import pty
import random
import re
import signal
import subprocess
import termios
import time
import urllib.request
from contextlib import contextmanager
from functools import partial

import pytest

from tailor.runtime.processes.child import Child, tailor
from tests.support.bus_system import guarded_robot, moving
from tests.support.driven import Driven, burners
from tests.support.patience import PATIENCE_S, wait_until
from tests.support.stalls import repeat_on_stall

pytestmark = pytest.mark.xdist_group("live")
SHELL_LIMIT_S = 1.0  # SAFETY.md, P45
RELEASE_LIMIT_S = 0.2  # a key or a signal
PAGE_LIMIT_S = 0.3  # a press over HTTP
SILENCE_LIMIT_S = 0.65  # half a second since its last message, which may be a period old; here the guard's and ours


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    """A robot that each test stops: as after each try, people arm it again, which resets the e-stop."""
    with guarded_robot(tmp_path_factory.mktemp("robot")) as (session, endpoint, start, trace):
        yield Driven(session, endpoint, start, trace)


def stopped_by(robot, action, limit_s):
    """Do something to a robot that moves; seconds from then to zero at the guard."""
    wait_until(robot.moves, "robot moves")
    began_s = time.monotonic()
    action()
    stopped_s = wait_until(lambda: robot.zero_after_s(began_s), "robot at rest")
    assert robot.executive.exit_code() is None, "nothing but the e-stop stopped the robot"
    assert wait_until(robot.modes, "driver state")[-1] == "estopped"
    assert stopped_s - began_s <= limit_s
    return stopped_s - began_s


@pytest.mark.promise("P45")
@pytest.mark.parametrize("tries", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_the_command_stops_a_robot_within_a_second(robot, tries, measured):
    phases = random.Random(1)
    command = tailor("estop", "--connect", robot.endpoint)

    def estop():
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S)
        assert (done.stdout, done.returncode) == ("agilo is estopped\n", 0), done.stderr

    for _ in range(tries):
        time.sleep(phases.uniform(0.0, 0.1))
        measured.add(repeat_on_stall(5, lambda: stopped_by(robot, estop, SHELL_LIMIT_S)), SHELL_LIMIT_S)


class Held:
    """`tailor estop --hold` in a terminal of its own."""

    def __init__(self, endpoint):
        self.terminal, theirs = pty.openpty()
        command = tailor("estop", "--hold", "--connect", endpoint)
        self.process = subprocess.Popen(
            command, stdin=theirs, stdout=subprocess.PIPE, text=True, start_new_session=True
        )
        os.close(theirs)
        assert "hears this switch" in wait_until(self._line, "a state")

    def _line(self):
        """The next line on a driver; empty if it is none."""
        line = self.process.stdout.readline()
        return line if line.startswith("agilo is") else ""

    def key(self, key=b" "):
        os.write(self.terminal, key)

    def key_after_the_shell_had_the_terminal(self):
        """After Ctrl-Z and `fg`, when a shell has set it up for whole lines."""
        settings = termios.tcgetattr(self.terminal)
        settings[3] |= termios.ICANON | termios.ECHO
        termios.tcsetattr(self.terminal, termios.TCSANOW, settings)
        self.key()

    def close(self):
        os.close(self.terminal)
        self.terminal = None

    def signal(self, number):
        os.kill(self.process.pid, number)

    def end(self):
        self.signal(signal.SIGKILL)
        self.process.wait()
        self.process.stdout.close()
        if self.terminal is not None:
            self.close()


WAYS = {
    "space": (Held.key, RELEASE_LIMIT_S),
    "space after fg": (Held.key_after_the_shell_had_the_terminal, RELEASE_LIMIT_S),
    "Enter": (lambda held: held.key(b"\n"), RELEASE_LIMIT_S),
    "Ctrl-C": (lambda held: held.signal(signal.SIGINT), RELEASE_LIMIT_S),
    "a closed terminal": (Held.close, RELEASE_LIMIT_S),
    "SIGTERM": (lambda held: held.signal(signal.SIGTERM), RELEASE_LIMIT_S),
    "kill -9": (lambda held: held.signal(signal.SIGKILL), SILENCE_LIMIT_S),
    "Ctrl-Z": (lambda held: held.signal(signal.SIGSTOP), SILENCE_LIMIT_S),
}


def released(robot, way, phase_s):
    held = Held(robot.endpoint)
    try:
        action, limit_s = WAYS[way]
        wait_until(robot.moves, "robot moves")
        time.sleep(0.7 + phase_s)
        assert moving(robot.trace, 0.5)(), "a held switch lets the robot drive"
        return stopped_by(robot, lambda: action(held), limit_s)
    finally:
        held.end()


@pytest.mark.promise("P45")
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("tries", [1, pytest.param(20, marks=pytest.mark.slow)])
def test_releasing_the_switch_stops_the_robot_by(robot, way, tries, measured):
    phases = random.Random(2)
    for _ in range(tries):
        once = partial(released, robot, way, phases.uniform(0.0, 0.1))
        measured.add(repeat_on_stall(5, once), WAYS[way][1], what=way)


def test_a_switch_without_a_hand_on_it_stops_at_once(robot):
    """Standard input is no terminal and has ended: nobody could release it."""
    command = tailor("estop", "--hold", "--connect", robot.endpoint)

    def hold():
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=PATIENCE_S)
        assert (done.stdout.splitlines()[-1], done.returncode) == ("agilo is estopped", 0), done.stderr

    stopped_by(robot, hold, 5.0)


@contextmanager
def live_page(endpoint, folder):
    """(address, token) of the live page of a viewer of its own."""
    log = folder / "view.log"
    with log.open("w") as file:
        view = Child("view", tailor("view", "--live", "--no-models", "--port", "0", "--connect", endpoint), file)
    try:
        wait_until(lambda: log.read_text().startswith("http"), "address")
        address = log.read_text().split()[0]
        with urllib.request.urlopen(address, timeout=PATIENCE_S) as response:
            yield address, re.search(r'"stop": *"([^"]+)"', response.read().decode()).group(1)
    finally:
        assert view.stop() == 0


@pytest.mark.promise("P45")
@pytest.mark.parametrize("tries", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_the_button_of_the_live_page_stops_the_robot(robot, tmp_path, tries, measured):
    phases = random.Random(3)
    with live_page(robot.endpoint, tmp_path) as (address, token):
        headers = {"Origin": address.rstrip("/"), "X-Stop-Token": token}

        def press():
            request = urllib.request.Request(f"{address}stop", b"", headers, method="POST")
            with urllib.request.urlopen(request, timeout=PATIENCE_S) as response:
                assert json.load(response) == {"confirmed": True, "drivers": {"agilo": "estopped"}, "connected": True}

        for _ in range(tries):
            time.sleep(phases.uniform(0.0, 0.1))
            measured.add(repeat_on_stall(5, lambda: stopped_by(robot, press, PAGE_LIMIT_S)), PAGE_LIMIT_S)


@pytest.mark.promise("P45")
@pytest.mark.slow
def test_a_held_switch_stops_nobody_on_a_busy_machine(robot):
    held = Held(robot.endpoint)
    try:
        wait_until(robot.moves, "robot moves")
        with burners():
            ends = time.monotonic() + 20.0
            while time.monotonic() < ends:
                assert "estopped" not in robot.modes()
    finally:
        held.end()
