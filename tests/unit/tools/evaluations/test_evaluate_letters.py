"""The letters' evaluation: its oracle knows what a reach takes, and its rows are over letters."""

import numpy as np

from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.action_library import REACH
from tailor.executive.domains.arm.belief import ArmBelief
from tailor.tools.evaluations.arm.perfect_reach import FRICTION, PerfectReach


def test_the_oracle_predicts_what_the_controller_plans():
    rng = np.random.default_rng(5)
    rows = rng.uniform(-0.9, 0.9, (200, 8)) * [1, 0.7, 1, 0.7, 1, 0.7, 1, 0.7]
    planned = []
    for row in rows:
        now = tuple(row[0:4:2].tolist()), tuple(row[1:4:2].tolist())
        for friction in FRICTION:
            belief = ArmBelief(0, *now, 0, friction=(friction, friction))
            planned.append(REACH.controller(None, 0, belief, row).state.cubic.duration_s - PERIOD_S)
    means = np.reshape(planned, (len(rows), -1)).mean(axis=1)
    predicted, spread = PerfectReach().predict(rows)
    assert np.abs(predicted - means).mean() < 0.04  # whole periods are planned
    assert (np.abs(predicted - means) < 0.11).mean() > 0.95  # two durations that cost alike may be told apart otherwise
    assert not spread.any()
