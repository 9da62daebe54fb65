"""A point with three axes, each of which follows its set-point with a limited acceleration."""

import math

import numpy as np

from tailor.simnodes.body import STEP_NS, Reading
from truck.topics import TruckState

STEP_S = STEP_NS * 1e-9
ACCELERATIONS = (0.8, 0.8, 0.5)  # m/s²
SIGMA_M = 0.003
STARTS = ("east", "north", "height", "east_rate", "north_rate", "lift_rate")


class Simulator:
    """See tailor.simnodes.body.Body."""

    robot = "truck-7"
    names = STARTS

    def __init__(self):
        self.reset(np.random.default_rng(0), {})

    def reset(self, rng, start):
        self._rng, self._time_ns, self._at, self._rates = rng, 0, [0.0] * 3, [0.0] * 3
        self.place(start)

    def place(self, values):
        state = dict(zip(STARTS, (*self._at, *self._rates), strict=True)) | dict(values)
        numbers = [state[name] for name in STARTS]
        self._at, self._rates = numbers[:3], numbers[3:]
        self._targets = tuple(self._rates)

    def command(self, values):
        self._targets = values

    def advance(self, duration_ns):
        readings = []
        for _ in range(duration_ns // STEP_NS):
            for axis, limit in enumerate(ACCELERATIONS):
                change = self._targets[axis] - self._rates[axis]
                self._rates[axis] += math.copysign(min(abs(change), limit * STEP_S), change)
                self._at[axis] += self._rates[axis] * STEP_S
            self._time_ns += STEP_NS
            if self._time_ns % 50_000_000 == 0:
                noise = (SIGMA_M * self._rng.standard_normal(3)).tolist()
                seen = [at + off for at, off in zip(self._at, noise, strict=True)]
                readings.append(
                    Reading("truck_tags", TruckState(self._time_ns, *seen, tuple(self._rates)), self._time_ns)
                )
            if self._time_ns % 100_000_000 == 0:
                readings.append(Reading("truck_exact", self.ground_truth(), self._time_ns))
        return readings

    def ground_truth(self):
        return TruckState(self._time_ns, *self._at, tuple(self._rates))
