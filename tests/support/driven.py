"""A stand-in robot that is driven, people who arm it again, and programs that keep the CPU busy."""

import sys
import time
from contextlib import contextmanager

from tailor.runtime.processes.child import Child
from tailor.schemas.messages import ArmRequest, DriverState
from tests.support.bus_system import armed_sender, driving, moving, zero_at

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


class Driven:
    """A stand-in robot that moves, an executive that drives it, and a person who arms it again after each stop."""

    def __init__(self, session, endpoint, start, trace):
        self.endpoint, self.trace = endpoint, trace
        self.states, self.arming = session.inbox(["driver"], "agilo"), session.publisher("arm_request", "agilo")
        self.executive = driving(start, endpoint, trace)
        self.sender = armed_sender(self.states)

    def moves(self):
        """A loaded machine may stop the robot by itself, for want of commands: then people arm it again."""
        if not moving(self.trace, 0.5)():
            self.arming.publish(ArmRequest(True, True, self.sender, 0))
            time.sleep(0.2)
        return moving(self.trace, 0.5)()

    def modes(self):
        time.sleep(0.3)  # three states
        return [s.message.mode for s in self.states.drain() if isinstance(s.message, DriverState)]

    def zero_after_s(self, since_s):
        """When the guard's output was zero for the first time since then, monotonic s; None if it never was."""
        return zero_at(self.trace, since_s)
