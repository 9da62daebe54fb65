"""An e-stop gets through on a busy machine: from the first call of a new session to zero at the guard."""

import socket
import sys
import time
from contextlib import ExitStack, contextmanager

import pytest

from tailor.runtime.bus.opening import open_client, open_router
from tailor.runtime.processes.child import Child
from tailor.schemas.messages import ArmRequest, DriverState, EStop
from tests.support.bus_system import driving, free_endpoint, guarded_robot, moving, outputs
from tests.support.patience import wait_until
from tests.support.stalls import repeat_on_stall

LIMIT_S = 0.2  # P38 of SAFETY.md
SILENT = 110  # zenoh's own limit of connections that have sent nothing is 100
BURN = "while True: pass"


@contextmanager
def burners():
    """Four processes that want two cores."""
    children = [Child("burner", [sys.executable, "-c", BURN]) for _ in range(4)]
    try:
        yield
    finally:
        for child in children:
            child.kill()


LOADS = {
    "nothing": ExitStack,
    "4 CPU burners": burners,
}


class Driven:
    """A stand-in robot that moves, an executive that drives it, and a person who arms it again after each stop."""

    def __init__(self, session, endpoint, start, trace):
        self.endpoint, self.trace = endpoint, trace
        self.executive = driving(start, endpoint, trace)
        self.states, self.arming = session.inbox(["driver"], "agilo"), session.publisher("arm_request", "agilo")
        self.sender = wait_until(lambda: [s.message.armed_sender for s in self.states.drain()], "driver")[-1]

    def moves(self):
        """A loaded machine may stop the robot by itself, for want of commands: then people arm it again."""
        if not moving(self.trace, 0.5)():
            self.arming.publish(ArmRequest(True, True, self.sender, 0))
            time.sleep(0.2)
        return moving(self.trace, 0.5)()

    def stopping_s(self):
        """Seconds from the decision to stop to zero at the guard."""
        wait_until(self.moves, "robot moves")
        began_s = time.monotonic()
        with open_client(self.endpoint) as session:
            publisher = session.publisher("estop", "")
            while outputs(self.trace)[-1][1] != 0.0:
                publisher.publish(EStop(True))
                time.sleep(0.02)
                assert time.monotonic() < began_s + 5.0, "the robot drives on"
        stopped_s = next(at for at, v in outputs(self.trace) if at > began_s and v == 0.0)
        assert self.executive.exit_code() is None, "it is the e-stop that stopped the robot"
        assert wait_until(self.modes, "driver state")[-1] == "estopped"
        assert stopped_s - began_s <= LIMIT_S
        return stopped_s - began_s

    def modes(self):
        time.sleep(0.3)  # three states
        return [s.message.mode for s in self.states.drain() if isinstance(s.message, DriverState)]


@pytest.mark.promise("P38")
@pytest.mark.xdist_group("live")
@pytest.mark.parametrize(
    ("load", "tries"), [("nothing", 3), *(pytest.param(load, 20, marks=pytest.mark.slow) for load in LOADS)]
)
def test_an_estop_stops_the_robot_within_200_ms_beside(tmp_path, load, tries, measured):
    with guarded_robot(tmp_path) as (session, endpoint, start, trace):
        robot = Driven(session, endpoint, start, trace)
        with LOADS[load]():
            for _ in range(tries):
                measured.add(repeat_on_stall(5, robot.stopping_s), LIMIT_S, what=f"beside {load}")


@pytest.mark.promise("P38")
def test_connections_that_send_nothing_keep_nobody_out():
    """As of a port scan. Closing them takes the router about 4 ms each; meanwhile a new session waits."""
    endpoint = free_endpoint()
    host, port = endpoint.removeprefix("tcp/").split(":")
    with open_router(endpoint), ExitStack() as stack:
        for _ in range(SILENT):
            stack.enter_context(socket.create_connection((host, int(port))))
        for _ in range(3):
            with open_client(endpoint, timeout_s=3.0):
                time.sleep(0.8)
