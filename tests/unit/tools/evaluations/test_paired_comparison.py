"""Paired statistics: independent units, tests of shares, intervals of ratios, thresholds for p."""

import argparse

import numpy as np
import pytest
from scipy import stats

from tailor.executive import domains
from tailor.schemas.installed import domain_names
from tailor.schemas.messages import ActionFinished, InstantiatedAction, Parameter, Subgoals
from tailor.schemas.messages.soccer import SoccerGroundTruth
from tailor.tools.evaluations import seeds
from tailor.tools.evaluations.costs import costs_of
from tailor.tools.evaluations.outcome import FIRST_SEED, Task, Variant
from tailor.tools.evaluations.paired_comparison import compare, compare_means, compare_shares, p_shown, ratio_interval
from tailor.tools.evaluations.task_runs import run_one
from tailor.tools.learning import fresh_seeds
from tailor.tools.lockstep.run import Run


def test_repeats_of_one_unit_do_not_narrow_the_interval():
    rng = np.random.default_rng(1)
    greedy = rng.uniform(9, 11, 12)
    refined = greedy * rng.uniform(0.8, 1.0, 12)
    once = compare(greedy, refined)
    repeated = compare(np.repeat(greedy, 5), np.repeat(refined, 5), np.repeat(range(12), 5).tolist())
    assert (repeated.n, repeated.units) == (60, 12)
    assert repeated.ci95 == pytest.approx(once.ci95)
    assert repeated.p_value == pytest.approx(once.p_value)


def test_shares_are_compared_by_the_pairs_that_differ():
    first = np.array([0] * 90 + [1] * 10, bool)
    second = np.array([0] * 80 + [1] * 20, bool)
    found = compare_shares(first, second)
    assert (found.first, found.second) == (10.0, 20.0)
    assert found.p_value == pytest.approx(stats.binomtest(10, 10).pvalue)
    assert found.ci95[0] < 10.0 < found.ci95[1]


def test_an_interval_of_a_share_is_not_empty_where_nothing_happened():
    nothing = np.zeros(100, bool)
    found = compare_shares(nothing, nothing)
    assert found.p_value == 1.0
    assert found.ci95[0] < 0.0 < found.ci95[1]
    assert found.ci95[1] < 5.0
    few = compare_shares(nothing, nothing, np.repeat(range(10), 10).tolist())
    assert few.ci95[1] > found.ci95[1]


def test_units_with_other_shares_are_compared_as_a_whole():
    first, second = np.zeros(40, bool), np.array([1, 0, 0, 0] * 9 + [0] * 4, bool)
    found = compare_shares(first, second, np.repeat(range(10), 4).tolist())
    assert (found.first, found.second) == (0.0, 22.5)
    assert found.ci95[0] > 0
    assert found == compare_means(np.zeros(10), np.array([25.0] * 9 + [0.0])), "not 40 pairs: they are of ten starts"


def test_the_interval_of_shares_covers_the_truth_as_often_as_it_promises():
    rng = np.random.default_rng(3)
    held = 0
    for _ in range(400):
        drawn = rng.random((200, 2)) < (0.02, 0.06)
        low, high = compare_shares(drawn[:, 0], drawn[:, 1]).ci95
        held += low <= 4.0 <= high
    assert 0.92 <= held / 400 <= 0.99


def test_means_are_compared_pair_by_pair():
    first = np.arange(10.0) * 100
    found = compare_means(first, first + 1 + 0.1 * np.sin(first))
    assert found.p_value < 0.001
    assert found.ci95[0] < 1.0 < found.ci95[1]
    assert found.ci95[1] - found.ci95[0] < 0.2


@pytest.mark.parametrize("count", [2, 3, 12])
def test_differences_without_spread_are_no_more_significant_than_their_number(count):
    """Durations are whole ticks, so that a few pairs may differ by the very same; t would be infinite."""
    greedy = 10 + 0.1 * np.arange(count)
    assert compare(greedy, greedy - 0.3).p_value == pytest.approx(2.0 ** (1 - count))
    assert compare_means(greedy, greedy - 0.3).p_value == pytest.approx(2.0 ** (1 - count))


@pytest.mark.parametrize(("count", "known"), [(2, False), (5, False), (6, True)])
def test_a_few_differences_without_spread_have_no_interval(count, known):
    """Two starts that gained the same counted as faster, at 95 %, beside a p of one half."""
    greedy = np.full(count, 10.0)
    for low, high in (compare(greedy, 0.9 * greedy).ci95, compare_means(greedy, greedy).ci95):
        assert np.isfinite([low, high]).all() == known
    assert (compare(greedy, 0.9 * greedy).ci95[0] > 0) == known


def test_durations_of_as_many_ticks_are_not_slower_for_when_they_began():
    """A run takes the seconds from one tick to another, and those are rounded."""
    ticks = np.array([51, 53, 54, 81, 86, 91])
    sooner_s, later_s = (ticks + 1) / 10 - 1 / 10, (ticks + 2) / 10 - 2 / 10
    assert (later_s > sooner_s).any()
    assert (later_s < sooner_s).any()
    assert (compare(sooner_s, later_s).slower_pct, compare(later_s, sooner_s).slower_pct) == (0.0, 0.0)
    assert compare(sooner_s, later_s + 0.1).slower_pct == 100.0


@pytest.mark.parametrize("count", [10, 20])
def test_the_interval_of_a_ratio_covers_the_truth_nearly_as_often_as_it_promises(count):
    """Gains and durations as of soccer's starts: between 2.5 % of the resamples a side 86 % of ten held it."""
    rng = np.random.default_rng(4)
    held = 0
    for _ in range(600):
        wholes = rng.lognormal(2.3, 0.35, count)
        low, high = ratio_interval(wholes * rng.normal(0.12, 0.1, count), wholes)
        held += low <= 0.12 <= high
    assert held / 600 >= 0.91


def test_the_interval_of_a_ratio_holds_it_and_narrows_with_more_starts():
    rng = np.random.default_rng(2)
    wholes = rng.uniform(1, 3, 400)
    parts = wholes * rng.uniform(0.5, 1.0, 400)
    wide, narrow = ratio_interval(parts[:20], wholes[:20]), ratio_interval(parts, wholes)
    assert narrow[0] < 0.75 < narrow[1]
    assert narrow[1] - narrow[0] < wide[1] - wide[0]


def test_a_ratio_over_few_units_has_no_interval():
    """A bootstrap of three held the truth in 75 of a hundred cases, and said 95."""
    rng = np.random.default_rng(2)
    wholes = rng.uniform(1, 3, 10)
    assert np.isnan(ratio_interval(0.1 * wholes[:9], wholes[:9])).all()
    assert np.isfinite(ratio_interval(0.1 * wholes, wholes)).all()


@pytest.mark.filterwarnings("error")
def test_a_ratio_of_which_the_whole_is_often_nothing_has_an_interval():
    rare = np.array([0.0] * 9 + [2.0])
    assert ratio_interval(0.5 * rare, rare) == pytest.approx((0.5, 0.5))
    assert np.isnan(ratio_interval(0.0 * rare, 0.0 * rare)).all()


def test_equal_differences_of_durations_have_equal_ranks():
    """As 10.1 - 9.8 and 5.3 - 5 differ in their last digits."""
    rng = np.random.default_rng(5)
    ticks = np.array([1, -1, 3, 3, 3, -2, 1, 1, -1, 2, 4, -3, 3, 1, 0])
    greedy = np.round(rng.uniform(5, 30, len(ticks)), 1)
    assert compare(greedy, greedy - 0.1 * ticks).p_wilcoxon == pytest.approx(stats.wilcoxon(ticks).pvalue)


def test_the_ranks_of_a_few_equal_differences_are_no_more_significant_than_their_number():
    assert compare([8.0, 9.0, 10.0], [7.7, 8.7, 9.7]).p_wilcoxon == 0.25
    assert compare([8.0, 9.0, 10.0], [8.0, 9.0, 10.0]).p_wilcoxon == 1.0


def test_p_values_below_the_threshold_are_not_told_apart():
    assert [p_shown(p) for p in (0.0, 9e-54, 0.0099, 0.5)] == ["< 0.001", "< 0.001", 0.01, 0.5]


@pytest.fixture
def first_seed(monkeypatch):
    def first(source="a", models="b", seed=None):
        monkeypatch.setattr(fresh_seeds, "runs_sha256", lambda domain: source)
        monkeypatch.setattr(fresh_seeds, "models_hash", lambda robot, zoo: models)
        return seeds.seeds_of("soccer", argparse.Namespace(zoo="", seed=seed))

    return first


def test_seeds_follow_from_source_and_models_alone(first_seed):
    assert first_seed() == first_seed()
    assert len({first_seed().first, first_seed(source="c").first, first_seed(models="c").first}) == 3
    assert FIRST_SEED <= first_seed().first < 2_000_000_000 - 100_000
    assert first_seed().provenance["seed_derived"]


def test_a_chosen_seed_is_stated(first_seed):
    chosen = first_seed(seed=7)
    assert (chosen.first, chosen.provenance["first_seed"], chosen.provenance["seed_derived"]) == (7, 7, False)
    assert list(chosen.starts(3)) == [7, 8, 9]


def test_costs_are_those_of_the_ground_truth():
    """An approach that pushes the ball away, and ends 0.1 m beside its goal."""
    action = domains.load("soccer").actions["goToPose"]
    goal = {"xg": 2.0, "yg": 1.0, "phig": 0.5, "vg": 0.2}
    parameters = [
        Parameter(p.name, k, "pos", p.unit, True, p.lower, p.upper, goal.get(p.name, 0.0))
        for k, p in enumerate(action.parameters)
    ]
    subgoals = Subgoals(0, 0, 2, (InstantiatedAction("goToPose", 1, False, 1.0, 0.1, tuple(parameters)),))
    truth = [
        SoccerGroundTruth(0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0),
        SoccerGroundTruth(900_000_000, 2.0, 1.1, 0.4, 0.5, 0.0, 3.0, 0.0, 0.0, 0.0),
    ]
    done = ActionFinished(1_000_000_000, 10, "goToPose", 0, "done", "", 1.0, 1.0)
    run = Run("achieved", 0.0, 1.0, [done], [subgoals], truth, [], [subgoals, *truth, done])
    costs = costs_of(run, domains.load("soccer"))
    assert costs.contacts == 0
    assert dict(costs.arrival) == pytest.approx({"position_m": 0.1, "heading_rad": 0.1, "speed_mps": 0.3})
    assert costs.energy_j > 0.1


@pytest.mark.parametrize("name", domain_names())
def test_a_run_of_every_domain_has_costs(name):
    outcome = run_one(Task(name, domains.scenarios(name)[0]), Variant("h1"), 1)
    assert outcome.achieved
    assert outcome.costs.energy_j > 0
    assert {column.partition("_")[0] for column, _ in outcome.costs.arrival} >= {"position", "speed"}
    assert all(0 <= error < 1 for _, error in outcome.costs.arrival)
