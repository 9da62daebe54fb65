"""A terminal that stands still, as after Ctrl-S, keeps nobody from stopping a robot, and no launcher from its work.

Nor does a log on a full disk.
"""

import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import termios
import time
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from tailor.runtime.bus.opening import open_client
from tailor.runtime.processes.child import tailor
from tailor.schemas.messages import DriverState
from tests.support.bus_system import accepts, answers, bus_system, child_pid, free_endpoint
from tests.support.patience import PATIENCE_S, wait_until

PLAIN_ROBOT = 'robot = "agilo"\n[bus]\nconnect = "tcp/127.0.0.1:1"\n[topics]\npose = ""\n[pose]\nstart = [0, 0, 0]\n'
pytestmark = pytest.mark.xdist_group("systems")


@contextmanager
def in_a_terminal(command, stalled=False):
    """Runs a command in a terminal; yields the end of the keyboard and screen, and that of the command."""
    master, slave = pty.openpty()
    if stalled:
        termios.tcflow(slave, termios.TCOOFF)
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 50, 200, 0, 0))
    process = subprocess.Popen(command, stdin=slave, stdout=slave, stderr=slave)
    try:
        yield master, slave
    finally:
        process.kill()
        process.wait(PATIENCE_S)
        os.close(master)
        os.close(slave)


def shows(screen, text):
    """Whether a terminal is sent a text; what it is sent is read."""
    seen = b""
    while select.select([screen], [], [], 0.05)[0]:
        seen += os.read(screen, 1 << 16)
    return text in seen


@pytest.mark.parametrize("key", [b"s", b"\x13"], ids=["s", "Ctrl-S"])
def test_the_stop_key_of_the_status_works_in_a_terminal_that_stands_still(key):
    with bus_system() as (session, endpoint, start):
        start("tailor.tools.main", "sim", "agilo", "--connect", endpoint)
        states = session.inbox(["driver"], "agilo")
        wait_until(lambda: states.drain(0), "driver state")
        with in_a_terminal(tailor("status", "--connect", endpoint)) as (screen, terminal):
            wait_until(lambda: shows(screen, b"EMERGENCY STOP"), "the status")
            termios.tcflow(terminal, termios.TCOOFF)
            time.sleep(0.6)  # it is drawn four times a second
            os.write(screen, key)

            def estopped():
                messages = [sample.message for sample in states.drain(0)]
                return any(isinstance(each, DriverState) and each.mode == "estopped" for each in messages)

            wait_until(estopped, "e-stop")


def test_a_driver_whose_terminal_stands_still_goes_on(tmp_path):
    """It waited for the terminal with its first line, and nobody heard it."""
    (tmp_path / "robot.toml").write_text(PLAIN_ROBOT)
    with bus_system() as (session, endpoint, _):
        states = session.inbox(["driver"], "agilo")
        command = tailor("driver", str(tmp_path / "robot.toml"), "--connect", endpoint)
        with in_a_terminal(command, stalled=True):
            wait_until(lambda: states.drain(0), "driver state")


def test_a_launcher_whose_terminal_stands_still_watches_its_children():
    endpoint = free_endpoint()
    with in_a_terminal(tailor("up", "soccer", "--no-scene", "--connect", endpoint)) as (screen, terminal):
        wait_until(lambda: shows(screen, b"EXECUTING"), "a robot that drives")
        with open_client(endpoint) as session:
            termios.tcflow(terminal, termios.TCOOFF)
            states = session.inbox(["processes"], "")
            time.sleep(1.5)  # until it has drawn
            states.drain(0)
            wait_until(lambda: states.drain(0), "states of the processes", timeout_s=5.0)


@pytest.mark.promise("P9")
def test_a_robot_drives_on_while_the_disk_of_its_launchers_log_is_full():
    """The launcher ended at its second line, and the robot stopped on its way."""
    endpoint = free_endpoint()
    words = tailor("up", "soccer", "--scenario", "approach", "--no-scene", "--connect", endpoint)
    with Path("/dev/full").open("w") as log:
        up = subprocess.Popen(words, stdout=log, stderr=log, stdin=subprocess.DEVNULL)
    try:
        wait_until(lambda: answers(endpoint), "router")
        with open_client(endpoint) as session:
            statuses = session.inbox(["status"], "")
            wait_until(lambda: any(s.message.result == "achieved" for s in statuses.drain()), "the goal")
            assert up.poll() is None
    finally:
        up.terminate()
        up.wait(PATIENCE_S)


@pytest.mark.promise("P9")
def test_a_bus_goes_on_while_the_disk_of_its_log_is_full():
    endpoint = free_endpoint()
    with Path("/dev/full").open("w") as log:
        bus = subprocess.Popen(tailor("bus", "--connect", endpoint), stdout=log, stderr=log)
    try:
        wait_until(lambda: accepts(endpoint), "gateway")
        first = child_pid(bus.pid, "gateway")
        os.kill(first, signal.SIGKILL)

        def next_one():
            with suppress(LookupError):
                return child_pid(bus.pid, "gateway") != first and accepts(endpoint)

        wait_until(next_one, "the next gateway, of which the log holds no line")
    finally:
        bus.terminate()
        bus.wait(PATIENCE_S)
