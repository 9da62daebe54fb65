"""The stand-in simulator with sensors that fail as scripted: a JSON file of rates in Hz by topic, read every period.

Arguments: endpoint, file of the trace, file of the rates. A topic that is not in the file has its own rate; 0: frozen.
The trace holds the largest magnitude of the set-points: the robot stands only if all are zero.
"""

import json
import sys
import time
from pathlib import Path

from tailor.runtime.bus.opening import open_client
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.simnodes.node import Node
from tailor.simnodes.world import World
from tests.support.stand_ins.sim import LIMITS, Traced


class Faulty(Traced):
    """Leaves out readings, so that no more than the wanted rate is published."""

    def __init__(self, path, rates):
        super().__init__(path)
        self.rates, self.published_ns = Path(rates), {}

    def traced(self, values):
        return max(abs(value) for value in values)

    def advance(self, duration_ns):
        rates = json.loads(self.rates.read_text()) if self.rates.exists() else {}
        return [reading for reading in super().advance(duration_ns) if self._is_due(reading, rates)]

    def _is_due(self, reading, rates):
        if reading.topic not in rates:
            return True
        rate_hz, last_ns = rates[reading.topic], self.published_ns.get(reading.topic, -(10**18))
        if rate_hz == 0 or reading.time_ns - last_ns < 1e9 / rate_hz:
            return False
        self.published_ns[reading.topic] = reading.time_ns
        return True


def main(endpoint, path, rates):
    stop = stop_on_signals()
    codec.prime()
    with open_client(endpoint, role="driver") as session:
        world = World(Faulty(path, rates), {}, 0)
        Node(world, LIMITS, session, MonotonicClock(), epoch=time.time_ns()).run(lambda: stop.requested)


if __name__ == "__main__":
    main(*sys.argv[1:])
