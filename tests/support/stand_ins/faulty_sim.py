"""The stand-in simulator with sensors that fail as scripted: a JSON file of rates in Hz by topic, read every period.

Arguments: endpoint, file of the trace, file of the rates. A topic that is not in the file has its own rate; 0: frozen.
The trace holds the largest magnitude of the set-points: the robot stands only if all are zero.
"""

import json
import sys
from pathlib import Path

from tests.support.stand_ins.sim import Traced, simulate


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


if __name__ == "__main__":
    endpoint, path, rates = sys.argv[1:]
    simulate(Faulty(path, rates), endpoint)
