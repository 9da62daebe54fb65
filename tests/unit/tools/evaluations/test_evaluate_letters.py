"""The letters' evaluation: its oracle knows what a reach takes, and its rows are of one kind with Table 3's."""

from argparse import Namespace

import numpy as np
import pytest

from tailor.executive.actions.cubic import best_duration_s
from tailor.executive.actions.reach import PERIOD_S
from tailor.executive.domains.arm.action_library import ACCELERATION_RADPS2
from tailor.executive.domains.arm.letters import font
from tailor.tools.evaluations.arm import letters
from tailor.tools.evaluations.arm.perfect_reach import PerfectReach


def test_the_oracle_says_what_the_controller_will_take():
    rng = np.random.default_rng(5)
    rows = rng.uniform(-0.9, 0.9, (300, 8)) * [1, 0.7, 1, 0.7, 1, 0.7, 1, 0.7]
    exact = [best_duration_s(r[0:4:2], r[1:4:2], r[4::2], r[5::2], ACCELERATION_RADPS2) - PERIOD_S for r in rows]
    said, spread = PerfectReach().predict(rows)
    assert (np.abs(said - exact) < 1e-4).mean() > 0.99  # two durations that cost alike may be told apart otherwise
    assert not spread.any()


def test_a_row_of_table_3_compares_the_same_letters(monkeypatch):
    monkeypatch.setattr(letters, "font", lambda: {"I": font()["I"], "L": font()["L"]})
    asked = Namespace(episodes=2, oracle=0, jobs=1, zoo="")
    row, (greedy_s, refined_s) = letters.table3_row(asked)
    assert row["n"] == len(greedy_s) == len(refined_s) == 2
    assert row["failed_greedy"] == row["failed_refined"] == 0
    assert row["mean_refined_s"] == pytest.approx(np.mean(refined_s))
    assert row["improvement_pct"] == pytest.approx(100 * np.mean(1 - np.array(refined_s) / greedy_s))
