"""Intervals hold nine tenths of fresh errors in every third of their widths, and the card states how many they hold."""

import numpy as np
import pytest

from tailor.models.regression.intervals import FORMER, MIN_OWN, OWN, RANDOM, Rows, fit_intervals
from tailor.models.training.calibration import MIN_EPISODES, coverage, judged


def heteroscedastic(count: int, seed: int):
    """Features, a std that is informative but of the wrong size, and skewed errors ten times as large at one end."""
    rng = np.random.default_rng(seed)
    features = rng.uniform(0, 1, (count, 3))
    scale = 0.05 + 0.5 * features[:, 0] ** 2
    std = 0.2 * scale * rng.uniform(0.8, 1.2, count)
    return features, std, scale * (rng.exponential(1.0, count) - 0.7)


def one_kind(count):
    return np.zeros(count, np.int64)


@pytest.fixture(scope="module")
def intervals():
    features, std, errors = heteroscedastic(3000, 1)
    return fit_intervals(Rows(features, std, errors), np.arange(3000), seed=1, kinds=one_kind(3000))


def test_every_third_of_the_widths_holds_nine_tenths_of_fresh_errors(intervals) -> None:
    features, std, errors = heteroscedastic(30_000, 2)
    lower, upper = intervals.around(features.astype(np.float32), np.zeros(len(errors)), std)
    result = coverage(errors, lower, upper)
    assert result["covers_thirds_pct"] == pytest.approx([90, 90, 90], abs=3)
    constant = coverage(errors, *(np.full(len(errors), np.quantile(errors, level)) for level in (0.05, 0.95)))
    assert result["winkler"] < 0.8 * constant["winkler"]


def test_choices_that_err_more_than_the_features_tell_are_held_as_well() -> None:
    def some(count: int, seed: int):
        features, std, errors = heteroscedastic(count, seed)
        chosen = np.arange(count) % 4 == 0
        return features, std, np.where(chosen, 1.5, 1) * errors, chosen

    features, std, errors, chosen = some(3000, 1)
    fitted = {
        alike: fit_intervals(Rows(features, std, errors), np.arange(3000), seed=1, kinds=kinds)
        for alike, kinds in ((True, one_kind(3000)), (False, chosen.astype(np.int64)))
    }
    features, std, errors, chosen = some(30_000, 2)
    held = {}
    for alike, intervals in fitted.items():
        lower, upper = intervals.around(features.astype(np.float32), np.zeros(len(errors)), std)
        held[alike] = coverage(errors[chosen], lower[chosen], upper[chosen])["covers_thirds_pct"]
    assert held[False] == pytest.approx([90, 90, 90], abs=3)
    assert max(held[True]) < 87


def test_the_widest_choices_are_held_though_random_episodes_are_wider() -> None:
    def some(count: int, seed: int):
        features, std, errors = heteroscedastic(count, seed)
        chosen = np.arange(count) % 4 == 0
        errs_more = chosen & (features[:, 0] > 0.4)
        inside = ~chosen | (features[:, 0] < 0.5)  # choices are among the surer episodes
        return (each[inside] for each in (features, std, np.where(errs_more, 2.0, 1) * errors, chosen))

    features, std, errors, chosen = some(6000, 1)
    intervals = fit_intervals(
        Rows(features, std, errors), np.arange(len(errors)), seed=1, kinds=chosen.astype(np.int64)
    )
    features, std, errors, chosen = some(60_000, 2)
    lower, upper = intervals.around(features.astype(np.float32), np.zeros(len(errors)), std)
    assert min(coverage(errors[chosen], lower[chosen], upper[chosen])["covers_thirds_pct"]) > 89


def fitted_with(own: Rows | None, former_err: float = 1.0, count: int = 3000):
    """Intervals of random episodes, a quarter of them former choices that err by another factor, and own choices."""
    rows = Rows(*heteroscedastic(count, 1))
    kinds = np.where(np.arange(count) % 4 == 0, FORMER, RANDOM)
    rows = Rows(rows.features, rows.std, np.where(kinds == FORMER, former_err, 1) * rows.errors)
    if own is not None:
        rows, kinds = rows.and_those_of(own), np.concatenate([kinds, np.full(len(own.errors), OWN)])
    return fit_intervals(rows, np.arange(len(kinds)), seed=1, kinds=kinds)


def held_pct(intervals, err: float = 1.0):
    """Share of fresh errors, larger by a factor, that intervals hold, in percent."""
    features, std, errors = heteroscedastic(30_000, 2)
    lower, upper = intervals.around(features.astype(np.float32), np.zeros(len(errors)), std)
    return coverage(err * errors, lower, upper)


def own_choices(count: int, err: float) -> Rows:
    features, std, errors = heteroscedastic(count, 4)
    return Rows(features, std, err * errors)


@pytest.mark.parametrize(("count", "within"), [(MIN_OWN, 5), (3000, 2)])
def test_choices_of_the_finished_model_correct_its_intervals(count: int, within: float) -> None:
    """Where the model errs half as much again, and those of former models show nothing of it."""
    without, corrected = (fitted_with(own) for own in (None, own_choices(count, 1.5)))
    assert held_pct(without, 1.5)["covers_pct"] == pytest.approx(71, abs=2)
    assert held_pct(corrected, 1.5)["covers_pct"] == pytest.approx(90, abs=within)


@pytest.mark.parametrize("err", [1.0, 0.2])
def test_own_choices_take_the_place_of_former_ones_and_random_episodes_stay_held(err: float) -> None:
    assert held_pct(fitted_with(None, former_err=3.0))["covers_pct"] > 95
    corrected = fitted_with(own_choices(600, err), former_err=3.0, count=6000)
    assert held_pct(corrected)["covers_pct"] == pytest.approx(91, abs=3)


def test_leaves_that_own_choices_prefer_for_being_too_narrow_are_widened_most() -> None:
    """As refinement does, choices are taken where a noisy width came out small; their errors are all alike."""
    rng = np.random.default_rng(5)

    def rows(count: int):
        return rng.uniform(0, 1, (count, 1)), np.full(count, 0.1), rng.normal(0, 1, count)

    features, std, errors = rows(1000)
    narrow = np.where(features[:, 0] < 0.3, 0.6, 1.3) * errors
    own = Rows(*rows(300))
    both = Rows(features, std, narrow).and_those_of(own)
    kinds = np.concatenate([np.full(1000, FORMER), np.full(300, OWN)])
    intervals = fit_intervals(both, np.arange(1300), seed=1, kinds=kinds)
    fresh, spread, seconds = rows(30_000)
    lower, upper = intervals.around(fresh.astype(np.float32), np.zeros(len(seconds)), spread)
    assert coverage(seconds, lower, upper)["covers_thirds_pct"] == pytest.approx([90, 90, 90], abs=4)


def test_skewed_errors_have_skewed_intervals(intervals) -> None:
    assert np.median(intervals.upper / -intervals.lower) == pytest.approx((np.log(20) - 0.7) / 0.65, rel=0.25)
    assert (intervals.lower < 0).all()


def test_few_episodes_give_one_interval_that_holds_them_all() -> None:
    features, std, errors = heteroscedastic(20, 3)
    few = fit_intervals(Rows(features, std, errors), np.arange(20), seed=1, kinds=one_kind(20))
    lower, upper = few.around(features.astype(np.float32), np.zeros(20), std)
    assert ((errors >= lower) & (errors <= upper)).mean() >= 0.9


def test_coverage_is_told_for_random_and_on_policy_episodes_apart() -> None:
    observed = np.concatenate([np.zeros(100), np.full(MIN_EPISODES, 2.0)])
    ends = np.full(len(observed), 1.0)
    on_policy = observed > 1
    entries = judged(observed, -ends, ends, on_policy)["intervals"]
    assert (entries["random"]["covers_pct"], entries["on_policy"]["covers_pct"]) == (100, 0)
    assert entries["on_policy"]["winkler"] == pytest.approx(2 + 20)
    assert set(judged(observed[1:-1], -ends[1:-1], ends[1:-1], on_policy[1:-1])["intervals"]) == {"random"}
    assert set(judged(observed[:5], -ends[:5], ends[:5], on_policy[:5])["intervals"]) == {"all"}
