"""The letters' evaluation: its oracle knows what a reach takes, and its rows are of one kind with Table 3's."""

import numpy as np

from tailor.executive.actions.cubic import best_duration_s
from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.action_library import ACCELERATION_RADPS2
from tailor.tools.evaluations.arm.perfect_reach import PerfectReach


def test_the_oracle_says_what_the_controller_will_take():
    rng = np.random.default_rng(5)
    rows = rng.uniform(-0.9, 0.9, (300, 8)) * [1, 0.7, 1, 0.7, 1, 0.7, 1, 0.7]
    exact = [best_duration_s(r[0:4:2], r[1:4:2], r[4::2], r[5::2], ACCELERATION_RADPS2) - PERIOD_S for r in rows]
    said, spread = PerfectReach().predict(rows)
    assert (np.abs(said - exact) < 1e-4).mean() > 0.99  # two durations that cost alike may be told apart otherwise
    assert not spread.any()
