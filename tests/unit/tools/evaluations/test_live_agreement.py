"""Live against lock-step: how runs are measured, and what counts as agreement."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tailor.tools.evaluations.live import live
from tailor.tools.evaluations.live.agreement import agreement, starts_of, with_thresholds
from tailor.tools.evaluations.live.bus_run import run_of
from tailor.tools.evaluations.live.equivalence import equivalence
from tailor.tools.evaluations.live.live_plot import draw_agreement
from tailor.tools.evaluations.outcome import Task, Variant, outcome_of
from tailor.tools.evaluations.task_runs import run_task
from tests.unit.tools.evaluations.test_refinement_evaluations import DONE

MARGIN_PCT = 5.0


def starts(run_s, lockstep_s):
    runs = {seed: replace(DONE, seed=seed, duration_s=s) for seed, s in enumerate(run_s)}
    repeats = {seed: [replace(DONE, duration_s=s) for s in some] for seed, some in enumerate(lockstep_s)}
    return starts_of(runs, repeats)


def drawn(rng, factor, count=20):
    lockstep_s = 10 * np.exp(0.08 * rng.standard_normal((count, 15)))
    return starts(factor * 10 * np.exp(0.08 * rng.standard_normal(count)), lockstep_s)


def test_a_run_read_from_its_messages_measures_as_the_run_itself():
    run, context = run_task(Task("soccer", "approach-dribble"), Variant("h2"), 700_000)
    truth = {id(message) for message in run.truth}
    keyed = [("agilo/sim/truth" if id(message) in truth else "exec/any", message) for message in run.messages]
    own, other = (outcome_of(r, context.domain, "h2", 1) for r in (run, run_of(keyed, run.result)))
    assert other.duration_s == pytest.approx(own.duration_s, abs=1e-6)
    assert (other.actions, other.actual_s, other.free, other.disturbance_m) == (
        own.actions, own.actual_s, own.free, own.disturbance_m,
    )  # fmt: skip


def test_equal_means_are_equivalent_only_when_there_is_enough_to_tell():
    apart = np.array([0.4, -0.4, 0.3, -0.3, 0.1, -0.1])
    assert equivalence(np.zeros(6), apart, 1.0).p_equivalent < 0.05
    assert equivalence(np.zeros(6), 10 * apart, 1.0).p_equivalent > 0.05
    assert equivalence(np.zeros(6), 10 * apart, 1.0).p_different > 0.9


def test_a_difference_beyond_the_margin_is_not_equivalent_however_sure():
    said = equivalence(np.zeros(40), 2 + 0.01 * np.arange(40), 1.0)
    assert said.p_equivalent > 0.99
    assert said.p_different < 1e-6
    assert said.ci95[0] < said.difference < said.ci95[1]


def test_runs_that_are_all_apart_by_the_same_need_no_test():
    assert equivalence([1.0, 2.0], [1.5, 2.5], 1.0).p_equivalent == 0.0
    assert equivalence([1.0, 2.0], [3.0, 4.0], 1.0).p_equivalent == 1.0


@pytest.mark.parametrize(("first", "second", "margin"), [([1.0], [1.0], 1.0), ([1.0, 2.0], [1.0, 2.0], 0.0)])
def test_too_little_to_test_is_refused(first, second, margin):
    with pytest.raises(ValueError, match="expected at least two"):
        equivalence(first, second, margin)


def test_lockstep_agrees_with_itself():
    row = agreement(drawn(np.random.default_rng(1), 1.0, 60), MARGIN_PCT)
    assert row["p_rank"] > 0.05
    assert row["equivalent"]
    assert row["within_range_expected_pct"] == pytest.approx(87.5)
    assert row["within_range_pct"] == pytest.approx(87.5, abs=10)


def test_runs_a_tenth_longer_are_found_out():
    row = agreement(drawn(np.random.default_rng(1), 1.1, 20), MARGIN_PCT)
    assert row["p_rank"] < 0.001
    assert row["p_value"] < 0.001
    assert not row["equivalent"]
    assert 5 < row["difference_pct"] < 15


def test_rank_of_a_run_among_its_starts_lockstep_runs():
    put = starts([1.0, 10.0, 2.0], [[2.0, 3.0, 4.0], [2.0, 3.0, 4.0], [2.0, 1.0, 3.0]])
    assert put.rank.tolist() == pytest.approx([1 / 8, 7 / 8, 1 / 2])


def test_runs_that_failed_are_left_out_of_the_durations():
    failed = replace(DONE, achieved=False)
    put = starts_of({1: failed, 2: DONE, 3: DONE}, {1: [DONE], 2: [failed, DONE], 3: [failed]})
    assert put.seeds == (2,)
    assert [len(some) for some in put.lockstep_s] == [1]


def test_a_live_run_that_failed_is_counted_and_says_why():
    runs = {1: DONE, 2: DONE, 3: replace(DONE, achieved=False, result="failed: the driver is stopped")}
    row = live._row("live", 2, runs, {seed: [DONE, replace(DONE, duration_s=11.0)] for seed in runs})
    assert (row["n"], row["achieved_lockstep_pct"]) == (2, 100.0)
    assert row["achieved_pct"] == pytest.approx(200 / 3)
    assert row["failures"] == "failed: the driver is stopped"


@pytest.mark.parametrize("achieved", [0, 1])
def test_live_runs_that_nearly_all_fail_have_a_row_without_durations(achieved, tmp_path):
    runs = {seed: replace(DONE, achieved=seed < achieved, result="failed: late") for seed in range(3)}
    repeats = {seed: [DONE, DONE] for seed in runs}
    row = live._row("live", 2, runs, repeats)
    assert (row["n"], row["failures"], row["equivalent"]) == (achieved, "failed: late", False)
    assert row["achieved_pct"] == pytest.approx(100 * achieved / 3)
    assert np.isnan([row["p_value"], row["p_rank"], *row["ci95_pct"]]).all()
    put = {name: starts_of(runs, repeats) for name in ("live", "once more")}
    assert draw_agreement(put, MARGIN_PCT, tmp_path / "live.png").exists()


def test_p_values_of_a_report_are_given_down_to_the_threshold():
    row = with_thresholds(agreement(drawn(np.random.default_rng(1), 1.2, 20), MARGIN_PCT))
    assert (row["p_value"], row["p_rank"], row["p_equivalent"]) == ("< 0.001", "< 0.001", 1.0)


def test_agreement_is_drawn(tmp_path):
    rng = np.random.default_rng(2)
    path = draw_agreement({"live": drawn(rng, 1.0), "once more": drawn(rng, 1.0)}, MARGIN_PCT, tmp_path / "live.png")
    assert path.stat().st_size > 10_000
