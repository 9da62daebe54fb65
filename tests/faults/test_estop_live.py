"""An e-stop gets through whatever others do: from the first call of a new session to zero at the guard."""

import random
import socket
import sys
import time
from contextlib import ExitStack, contextmanager

import pytest

from tailor.runtime.bus.opening import open_client, open_router
from tailor.runtime.processes.child import Child
from tailor.schemas.messages import ArmRequest, EStop
from tailor.schemas.topics import TOPICS
from tests.support.bus_system import address, free_endpoint, guarded_robot, moving, outputs, secured_system
from tests.support.driven import Driven, burners
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

LIMIT_S = 0.2  # P38 of SAFETY.md
SILENT = 110  # zenoh's own limit of connections that have sent nothing is 100
MANY_SILENT = 1200
PHASES = random.Random(0)
OTHERS = tuple(name for name in TOPICS if name not in ("driver", "self_arm"))  # the one shows, the other takes the stop
FLOODS = {
    "its key": [("people", "estop"), ("people", "estop:junk"), ("observer", "estop")],
    "all keys": [("driver", *OTHERS), ("executive", *OTHERS), ("observer", *TOPICS)],
}


@contextmanager
def silent_connections(endpoint, count=MANY_SILENT):
    """Connections that never send a byte, as of a port scan; the gateway closes them after a second: then anew."""
    with ExitStack() as stack:
        for _ in range(count):
            stack.enter_context(socket.create_connection(address(endpoint)))
        time.sleep(PHASES.uniform(0.0, 3.0))  # before, while and after the gateway closes them
        yield


@contextmanager
def flood(endpoint, processes):
    """Processes that publish as fast as they can, until the end."""
    with ExitStack() as stack:
        for words in processes:
            line = [sys.executable, "-m", "tests.support.stand_ins.flood", endpoint, *words]
            stack.callback(Child("flood", line).kill)
        time.sleep(2.0)  # they have begun
        yield


LOADS = {
    "nothing": lambda endpoint: ExitStack(),
    "4 CPU burners": lambda endpoint: burners(),
    f"{MANY_SILENT} silent connections": silent_connections,
    **{f"floods of {name}": lambda endpoint, rows=rows: flood(endpoint, rows) for name, rows in FLOODS.items()},
}


def stopping_s(robot):
    """Seconds from the decision to stop to zero at the guard."""
    wait_until(robot.moves, "robot moves")
    began_s = time.monotonic()
    with open_client(robot.endpoint, role="people") as session:
        publisher = session.publisher("estop", "")
        while outputs(robot.trace)[-1][1] != 0.0:
            publisher.publish(EStop(True))
            time.sleep(0.02)
            assert time.monotonic() < began_s + 5.0, "the robot drives on"
    stopped_s = robot.zero_after_s(began_s)
    assert robot.executive.exit_code() is None, "it is the e-stop that stopped the robot"
    assert wait_until(robot.modes, "driver state")[-1] == "estopped"
    assert stopped_s - began_s <= LIMIT_S
    return stopped_s - began_s


@pytest.mark.promise("P38")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize(
    ("load", "tries"),
    [
        ("nothing", 3),
        (f"{MANY_SILENT} silent connections", 3),
        *(pytest.param(load, 20, marks=pytest.mark.slow) for load in LOADS),
    ],
)
def test_an_estop_stops_the_robot_within_200_ms_beside(tmp_path, load, tries, measured):
    with guarded_robot(tmp_path, secured_system) as (session, endpoint, start, trace):
        robot = Driven(session, endpoint, start, trace)
        for _ in range(tries):
            wait_until(robot.moves, "robot moves")
            with LOADS[load](endpoint):
                measured.add(repeat_on_stall(5, lambda: stopping_s(robot)), LIMIT_S, what=f"beside {load}")


@pytest.mark.promise("P38")
@pytest.mark.xdist_group("live")
def test_an_estop_is_latched_until_people_reset_it(tmp_path):
    with guarded_robot(tmp_path) as (session, endpoint, start, trace):
        robot = Driven(session, endpoint, start, trace)
        stopping_s(robot)
        for request in (ArmRequest(True, False, robot.sender, 0), ArmRequest(False, True, "", 0)):
            stopped_s = time.monotonic()
            robot.arming.publish(request)
            assert robot.modes()[-1] == "estopped"
            assert [v for at, v in outputs(trace) if at > stopped_s] == []
        robot.arming.publish(ArmRequest(True, True, robot.sender, 0))
        wait_until(moving(trace, 0.5), "the robot moves after people have reset the e-stop")


@pytest.mark.promise("P38")
def test_connections_that_send_nothing_keep_nobody_out():
    """As of a port scan. Closing them takes the router about 4 ms each; meanwhile a new session waits."""
    endpoint = free_endpoint()
    with open_router(endpoint), ExitStack() as stack:
        for _ in range(SILENT):
            stack.enter_context(socket.create_connection(address(endpoint)))
        for _ in range(3):
            with open_client(endpoint, timeout_s=3.0):
                time.sleep(0.8)
