"""Evaluations of refinement: the paper's statistics, episodes kept over a break, baselines told apart."""

from __future__ import annotations

import argparse
from dataclasses import replace

import numpy as np
import pytest

from executive.library import Interval
from schemas.errors import UsageError
from tools.evaluations import benefit, figure1, figure11, figure15, figure16, live, table3, table4
from tools.evaluations.comparison import compare, share_interval
from tools.evaluations.journal import Journal
from tools.evaluations.oracle import _judged, _values, subgoal_parameters
from tools.evaluations.outcome import Outcome, Task, Variant
from tools.evaluations.pinned import PinnedDomain
from tools.evaluations.table3 import against_oracle
from tools.evaluations.trials import paired

DONE = Outcome(
    seed=1,
    variant="h1",
    achieved=True,
    duration_s=10.0,
    result="achieved",
    actions=("approachBall", "dribbleBall"),
    outcomes=("done", "done"),
    predicted_s=(4.0, 5.0),
    actual_s=(4.0, 6.0),
    asserted=False,
    ball_moved_m=0.0,
    free=(("pos2", "phi", -3.0, 3.0, 0.5), ("subgoal12", "x", -3.0, 3.0, 1.0)),
    bound=(("pos1", "x", 0.0),),
    greedy_cost_s=11.0,
    refined_cost_s=10.0,
)


def test_improvement_is_the_mean_of_the_paired_ratios():
    said = compare([10.0, 20.0, 10.0, 10.0], [9.0, 10.0, 11.0, 10.0])
    assert said.improvement_pct == pytest.approx(100 * np.mean([0.1, 0.5, -0.1, 0.0]))
    assert said.gain_of_means_pct == pytest.approx(100 * (1 - 40 / 50))
    assert said.slower_pct == 25.0
    assert said.ci95[0] < said.improvement_pct < said.ci95[1]


def test_no_difference_is_not_significant():
    said = compare([10.0, 12.0], [10.0, 12.0])
    assert (said.improvement_pct, said.p_value, said.p_wilcoxon) == (0.0, 1.0, 1.0)


def test_unequal_or_single_pairs_are_refused():
    for first, second in (([1.0], [1.0]), ([1.0, 2.0], [1.0])):
        with pytest.raises(ValueError, match="pairs"):
            compare(first, second)


def test_share_of_nothing_is_unknown():
    assert share_interval(0, 0) == (0.0, 100.0)
    low, high = share_interval(98, 100)
    assert low < 98 < high


def test_only_episodes_that_both_reached_the_goal_are_paired():
    failed = replace(DONE, seed=2, achieved=False)
    assert paired({1: DONE, 2: DONE}, {1: replace(DONE, duration_s=9.0), 2: failed}) == ([10.0], [9.0])


def test_finished_episodes_survive_a_break_and_a_torn_line(tmp_path):
    task, variant = Task("soccer", "approach-dribble"), Variant("h1")
    Journal(tmp_path, task, variant, ["a"]).note(DONE)
    next(tmp_path.iterdir()).open("a").write('{"seed": 2, "vari')
    again = Journal(tmp_path, task, variant, ["a"])
    assert again.known == {1: DONE}
    again.note(replace(DONE, seed=3))
    assert sorted(Journal(tmp_path, task, variant, ["a"]).known) == [1, 3]


def test_other_models_or_settings_are_other_episodes(tmp_path):
    task, variant = Task("soccer", "approach-dribble"), Variant("h1")
    Journal(tmp_path, task, variant, ["a"]).note(DONE)
    assert Journal(tmp_path, task, variant, ["b"]).known == {}
    other = replace(variant, refinement=replace(variant.refinement, k_std=2.0))
    assert Journal(tmp_path, task, other, ["a"]).known == {}


def test_pin_binds_what_is_free_and_nothing_else():
    class Inner:
        name = "inner"

        def value(self, quantity, label, *rest):
            return {"x": Interval(1.0, 1.0), "v": Interval(0.0, 0.3)}.get(quantity)

    domain = PinnedDomain(Inner(), {("pos2", "v"): 0.1, ("pos2", "x"): 5.0, ("pos2", "phi"): 2.0})
    rest = ((), (), None, None)
    assert domain.value("v", "pos2", *rest) == Interval(0.1, 0.1)
    assert domain.value("phi", "pos2", *rest) == Interval(2.0, 2.0)
    assert domain.value("x", "pos2", *rest) == Interval(1.0, 1.0)
    assert domain.value("v", "pos3", *rest) == Interval(0.0, 0.3)
    assert domain.name == "inner"


def test_oracle_tells_ceiling_greedy_and_zero_apart():
    slow_start = replace(DONE, duration_s=8.0, actual_s=(5.0, 3.0))
    quick_start = replace(DONE, duration_s=12.0, actual_s=(3.0, 9.0))
    failed = replace(DONE, achieved=False, duration_s=1.0)
    said = _judged(1, [slow_start, quick_start, failed], DONE)
    assert (said.ceiling_s, said.greedy_s, said.zero_s) == (8.0, 12.0, 10.0)
    row = against_oracle([said], {1: DONE}, {1: replace(DONE, duration_s=9.0)})
    assert row["oracle_pct"] == pytest.approx(20.0)
    assert row["refined_same_starts_pct"] == pytest.approx(10.0)


def test_oracle_chooses_for_the_plan_not_for_detours():
    assert subgoal_parameters(DONE) == [("pos2", "phi", -3.0, 3.0)]
    assert len(_values(("pos2", "phi", -np.pi, np.pi), 12)) == 12
    assert _values(("pos2", "v", 0.0, 0.3), 12) == pytest.approx([0.0, 0.15, 0.3])


def test_assertion_is_counted_as_the_paper_counts_it():
    approach = replace(DONE, actions=("approachBall",), outcomes=("done",), predicted_s=(4.0,), actual_s=(4.0,))
    bumped = replace(approach, ball_moved_m=0.2)
    detour = replace(approach, asserted=True, actual_s=(4.4,))
    before = {1: approach, 2: bumped, 3: approach, 4: approach}
    after = {1: approach, 2: detour, 3: detour, 4: replace(detour, actual_s=(4.8,))}
    row = figure16.summary(before, after)
    assert row["success_before_pct"] == 75.0
    assert row["success_after_pct"] == 100.0
    assert row["needless_pct"] == 50.0
    assert row["needless_slower_pct"] == pytest.approx(15.0)
    assert row["predicted_fail_observed_success_pct"] == 75.0


@pytest.mark.parametrize("module", [table3, table4, figure1, figure11, figure15, figure16, benefit, live])
def test_every_evaluation_has_the_same_flags(module):
    parser = argparse.ArgumentParser()
    module.configure(parser)
    given = parser.parse_args(["--episodes", "3", "--jobs", "1", "--json"])
    assert (given.episodes, given.jobs, given.json) == (3, 1, True)


@pytest.mark.parametrize("module", [table3, table4])
def test_unknown_scenario_is_a_usage_error(module):
    parser = argparse.ArgumentParser()
    module.configure(parser)
    with pytest.raises(UsageError, match="chess"):
        module.run(parser.parse_args(["chess"]))
