"""The sensitivity to a parameter is the mean change of the whole cost, though only some stages are evaluated for it."""

import numpy as np

from tailor.executive.refinement.certificates.sensitivity import PROBE_STEP, PROBES, sensitivity
from tests.unit.executive.refinement.solvers.test_chain_solver import Legs


def test_it_is_the_mean_change_of_the_whole_cost():
    objective = Legs(3)
    ranges = objective.ranges
    probes = ranges.draw(PROBES, np.random.default_rng(0))
    for parameter, found in enumerate(sensitivity(objective)):
        moved = probes.copy()
        moved[:, parameter] += PROBE_STEP * ranges.width[parameter]
        change = np.abs(objective(ranges.confine(moved)) - objective(probes)).mean()
        np.testing.assert_allclose(found, change / ranges.width[parameter])
