"""Figures of `evaluate assertion`, and runs in the kitchen."""

import math
from dataclasses import replace

import pytest

from tailor.tools.evaluations.assertion import assertion
from tailor.tools.evaluations.costs import Costs
from tailor.tools.evaluations.outcome import Outcome, Task
from tailor.tools.evaluations.task_runs import run_one


@pytest.mark.parametrize(("variant", "touched"), [(0, True), (1, False), (2, False)])
def test_subgoals_and_detours_lead_around_the_kitchens_stool(variant, touched):
    outcome = run_one(Task("kitchen", "to-cupboard"), assertion.variants()[variant], seed=700002)
    assert outcome.achieved
    assert (outcome.costs.contacts > 0) == touched


NONE = Outcome(0, "", True, 5.0, "achieved", (), (), (), (), False, 0.0, (), ())


def outcome(seconds=5.0, contacts=0, asserted=False, achieved=True):
    return replace(NONE, duration_s=seconds, asserted=asserted, achieved=achieved, costs=Costs(contacts, 0.0, ()))


def test_a_row_counts_contacts_as_failures_and_needless_subgoals():
    found = {
        "before": {0: outcome(), 1: outcome(5.0), 2: outcome(contacts=1), 3: outcome(achieved=False)},
        "after": {0: outcome(), 1: outcome(5.5, asserted=True), 2: outcome(6.0, asserted=True), 3: outcome(contacts=2)},
        "baseline": {0: outcome(5.5), 1: outcome(5.5), 2: outcome(6.0), 3: outcome(7.0)},
    }
    row = assertion.row(found, range(4))
    assert (row["success_before_pct"], row["success_after_pct"], row["baseline_success_pct"]) == (50, 75, 100)
    assert row["needless_pct"] == 25
    assert math.isnan(row["needless_slower_pct"]), "one start has no mean"
    assert row["baseline_slower_pct"] == pytest.approx(10)
    assert row["after_slower_pct"] == pytest.approx(5)
    assert not assertion.reached(row)
    assert assertion.reached({"success_after_pct": 98.5, "needless_slower_pct": 7.0})
    assert not assertion.reached({"success_after_pct": 99.5, "needless_slower_pct": 9.0})


def test_what_a_few_needless_subgoals_cost_has_the_interval_of_a_few():
    before = {seed: outcome(10.0) for seed in range(3)}
    after = {seed: outcome(10.0 + seed, asserted=True) for seed in range(3)}
    row = assertion.row({"before": before, "after": after, "baseline": before}, range(3))
    assert row["needless_slower_pct"] == pytest.approx(10)
    assert row["ci95_needless_slower"] == pytest.approx((10 - 4.303 * 10 / 3**0.5, 10 + 4.303 * 10 / 3**0.5), abs=0.01)
    assert row["ci95_after_to_baseline"] == row["ci95_needless_slower"]


def test_what_caution_costs_counts_starts_without_a_subgoal_and_has_an_interval():
    before = {seed: outcome(10.0) for seed in range(3)}
    after = {seed: outcome(10.0 + seed) for seed in range(3)}
    row = assertion.row({"before": before, "after": after, "baseline": before}, range(3))
    assert row["needless_pct"] == 0
    assert row["after_slower_pct"] == pytest.approx(10)
    assert row["ci95_after_slower"] == pytest.approx((10 - 4.303 * 10 / 3**0.5, 10 + 4.303 * 10 / 3**0.5), abs=0.01)
    assert row["ci95_baseline_slower"] == (-math.inf, math.inf), "three that are equal tell nothing of others"
