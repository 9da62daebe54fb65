"""A bus on a free loopback port, with child processes that end with the test; and a stand-in robot on it."""

import socket
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

from tailor.runtime.bus.opening import open_client, open_local_router, open_router
from tailor.runtime.processes.child import Child
from tailor.schemas.errors import UsageError
from tailor.tools.launch.hosting import free_endpoint
from tests.support.patience import wait_until

ROOT = Path(__file__).resolve().parents[2]


@contextmanager
def bus_system():
    """Yields (router session, endpoint, start), where start(module, *arguments) runs one of our modules."""
    endpoint = free_endpoint()
    with open_router(endpoint) as session, started() as start:
        yield session, endpoint, start


@contextmanager
def secured_system():
    """As `bus_system`, with passwords of this run, and a gateway process at the endpoint."""
    endpoint = free_endpoint()
    with open_local_router(endpoint) as (session, _), started() as start:
        start("tailor.tools.main", "gateway", "--connect", endpoint)
        wait_until(lambda: accepts(endpoint), "gateway")
        yield session, endpoint, start


@contextmanager
def started():
    """Yields start(module, *arguments), whose processes end with the context."""
    children = []

    def start(module, *arguments):
        isolated = ["-P"] if module.startswith("tailor.") else []  # our stand-ins are found from the current folder
        children.append(Child(module, [sys.executable, *isolated, "-m", module, *map(str, arguments)]))
        return children[-1]

    try:
        yield start
    finally:
        for child in children:
            child.kill()


def accepts(endpoint):
    """Whether something listens there."""
    with socket.socket() as probe:
        return probe.connect_ex(address(endpoint)) == 0


def address(endpoint):
    """Host and port of a TCP endpoint."""
    host, _, port = endpoint.removeprefix("tcp/").rpartition(":")
    return host, int(port)


@contextmanager
def guarded_robot(tmp_path, system=bus_system):
    """A bus with the stand-in simulator: yields (session, endpoint, start, trace of the guard's output)."""
    with system() as (session, endpoint, start):
        trace = tmp_path / "trace"
        start("tests.support.stand_ins.sim", endpoint, trace)
        wait_until(session.inbox(["driver"], "agilo").drain, "driver state")
        yield session, endpoint, start, trace


def answers(endpoint):
    """Whether a router is there."""
    try:
        with open_client(endpoint, timeout_s=0.5):
            return True
    except UsageError:
        return False


def outputs(trace):
    """The guard's output over time: [(monotonic s, speed)]."""
    rows = [line.split() for line in trace.read_text().splitlines() if line.count(" ") == 1]
    return [(int(at) / 1e9, float(v)) for at, v in rows]


def zero_at(trace, since_s):
    """When the guard's output became zero after `since_s`, monotonic s; None if it did not."""
    return next((at for at, v in outputs(trace) if at > since_s and v == 0.0), None)


def moving(trace, speed):
    """Whether the guard's output is that speed, as a function."""
    return lambda: trace.exists() and outputs(trace) and outputs(trace)[-1][1] == speed


def driving(start, endpoint, trace, speed=0.5):
    """An executive that drives the stand-in robot, which moves by now."""
    executive = start("tests.support.stand_ins.executive", endpoint, speed)
    wait_until(moving(trace, speed), "robot moves")
    return executive


def armed_sender(states):
    """Sender that the driver obeys, from an inbox that was opened before it was armed.

    Until the state is published that follows, and once a loaded machine has stopped the robot, it obeys nobody.
    """
    seen = wait_until(lambda: [s.message.armed_sender for s in states.drain() if s.message.armed_sender], "sender")
    return seen[-1]


def child_pid(parent, name):
    """Process id of the child of the launcher `parent` that runs `tailor NAME`."""
    for line in Path(f"/proc/{parent}/task/{parent}/children").read_text().split():
        with suppress(FileNotFoundError, ProcessLookupError):  # it has ended meanwhile
            if f"tailor.tools.main\0{name}\0" in Path(f"/proc/{line}/cmdline").read_text():
                return int(line)
    raise LookupError(name)
