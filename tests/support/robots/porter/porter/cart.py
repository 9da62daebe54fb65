"""A cart on a rail whose speed, and a gripper whose width, follow their set-points with limits."""

import math

import numpy as np

from porter.messages import PorterState
from tailor.simnodes.body import STEP_NS, Reading

STEP_S = STEP_NS * 1e-9
CART_MPS2, GRIPPER_MPS = 0.8, 0.06
SIGMA_M = 0.002


class Cart:
    """See tailor.simnodes.body.Body."""

    robot = "porter-3"
    names = ("along", "rate", "width")

    def __init__(self):
        self.reset(np.random.default_rng(0), {})

    def reset(self, rng, start):
        self._rng, self._time_ns = rng, 0
        self._along, self._rate, self._width = 0.0, 0.0, 0.12
        self.place(start)

    def place(self, values):
        self._along = values.get("along", self._along)
        self._rate = values.get("rate", self._rate)
        self._width = values.get("width", self._width)
        self._targets = (self._rate, self._width)

    def command(self, values):
        self._targets = values

    def advance(self, duration_ns):
        readings = []
        for _ in range(duration_ns // STEP_NS):
            self._rate += _limited(self._targets[0] - self._rate, CART_MPS2 * STEP_S)
            self._along += self._rate * STEP_S
            self._width += _limited(self._targets[1] - self._width, GRIPPER_MPS * STEP_S)
            self._time_ns += STEP_NS
            if self._time_ns % 50_000_000 == 0:
                seen = self._along + SIGMA_M * self._rng.standard_normal()
                readings.append(
                    Reading("porter_state", PorterState(self._time_ns, seen, self._rate, self._width), self._time_ns)
                )
            if self._time_ns % 100_000_000 == 0:
                readings.append(Reading("porter_exact", self.ground_truth(), self._time_ns))
        return readings

    def ground_truth(self):
        return PorterState(self._time_ns, self._along, self._rate, self._width)


def _limited(change, most):
    return math.copysign(min(abs(change), most), change)
