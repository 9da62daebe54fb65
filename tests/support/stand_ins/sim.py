"""A sim node with the fake body in its own process; writes every change of the guard's output with its time.

Arguments: endpoint, file.
"""

import sys
import time

from tailor.runtime.bus.opening import open_client
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.simnodes.driver_spec import DriverSpec
from tailor.simnodes.guard import Limit
from tailor.simnodes.node import Node
from tailor.simnodes.world import World
from tests.support.stand_ins.body import FakeBody

LIMITS = DriverSpec("cmd_vel", ("v", "omega"), (Limit(-1.0, 1.0), Limit(-2.0, 2.0)))


class Traced(FakeBody):
    """Writes every change of the set-points to a file."""

    def __init__(self, path):
        self.trace = open(path, "w", buffering=1)  # noqa: SIM115  lives as long as the process
        self.last = None

    def command(self, values):
        super().command(values)
        if values != self.last:
            self.trace.write(f"{time.monotonic_ns()} {self.traced(values)!r}\n")
            self.last = values

    def traced(self, values):
        """The number that stands for the set-points in the trace."""
        return values[0]


def simulate(body, endpoint):
    """Run a sim node with a body until a signal ends it."""
    stop = stop_on_signals()
    codec.prime()
    with open_client(endpoint, role="driver") as session:
        world = World(body, {}, 0)
        Node(world, LIMITS, session, MonotonicClock(), epoch=time.time_ns()).run(lambda: stop.requested)


if __name__ == "__main__":
    endpoint, path = sys.argv[1:]
    simulate(Traced(path), endpoint)
