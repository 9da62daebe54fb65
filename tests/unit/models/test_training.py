"""Episodes to a model that is published and loaded again, on a kinematic stand-in."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from tailor.models import runtime
from tailor.models.episodes.episodes import DataSet, Episode
from tailor.models.episodes.regression_targets import DURATION, ENERGY
from tailor.models.export.publishing import Publication, publish
from tailor.models.features.planar import projective
from tailor.models.training import first_ticks, learners
from tailor.models.training.first_ticks import best_n_i
from tailor.models.training.success_training import train_success
from tailor.models.training.training import Trained, train_duration, train_duration_beside, train_regression
from tailor.schemas.errors import UsageError
from tests.support import standin

ARGUMENTS = [{"name": q.name, "unit": q.unit, "lower": -4.0, "upper": 4.0} for q in projective.arguments]


@lru_cache(maxsize=3)
def data_set(count: int, seed: int = 1) -> DataSet:
    made = standin.episodes(count, seed)
    episodes = tuple(Episode(k, t[0], t, d, ok, "" if ok else "ball") for k, (t, d, ok) in enumerate(made))
    return DataSet({"robot": "toy", "action": "goToPose", "arguments": ARGUMENTS}, episodes, "0" * 64)


@pytest.fixture(scope="module")
def data() -> DataSet:
    return data_set(240)


@pytest.fixture(scope="module")
def duration(data: DataSet) -> Trained:
    return train_duration(data.episodes, projective, "linear", seed=3)


def test_first_ticks_are_chosen_by_the_learner_that_ships(data, monkeypatch) -> None:
    """One network stands for several, a tree for a bag, both for their stack."""
    tried = []

    def noted(single, *_):
        tried.append(single)
        return np.full(40, float(len(tried)))

    monkeypatch.setattr(first_ticks, "_cross_validated_errors", noted)
    for learner in ("network", "bag", "best"):
        space, rng = projective, np.random.default_rng(0)
        singles = learners.single_learners(learner, 3)
        assert best_n_i(DURATION, data.episodes, np.arange(40), space, singles, rng) == 1
    kinds = [type(single).__name__ for single in tried]
    assert kinds[:10] == ["NetworkRegressor"] * 5 + ["ModelTreeRegressor"] * 5
    assert kinds[10:] == ["ModelTreeRegressor", "NetworkRegressor"] * 5
    assert tried[0].networks == 1


def test_the_least_error_of_any_member_decides_how_many_first_ticks(data, monkeypatch) -> None:
    errors = iter([3.0, 5.0, 3.0, 5.0, 9.0, 2.0, 3.0, 3.0, 4.0, 4.0])
    monkeypatch.setattr(first_ticks, "_cross_validated_errors", lambda *_: np.full(40, next(errors)))
    singles, rng = learners.single_learners("best", 3), np.random.default_rng(0)
    assert best_n_i(DURATION, data.episodes, np.arange(40), projective, singles, rng) == 5


@pytest.mark.parametrize(("gain", "expected"), [(0.05, 1), (0.5, 2)])
def test_more_first_ticks_must_be_clearly_better(data, monkeypatch, gain, expected) -> None:
    """Errors of 100 episodes differ by 1 from choice to choice, so that a gain of 0.2 is two standard errors."""
    luck = np.random.default_rng(1).permutation(np.repeat([-1.0, 1.0], 50))
    errors = iter([np.full(100, 5.0), 5.0 - gain + luck, *[np.full(100, 9.0)] * 3])
    monkeypatch.setattr(first_ticks, "_cross_validated_errors", lambda *_: next(errors))
    singles, rng = learners.single_learners("network", 3), np.random.default_rng(0)
    assert best_n_i(DURATION, data.episodes, np.arange(40), projective, singles, rng) == expected


def test_a_published_duration_model_predicts_what_its_learner_does(data, duration, tmp_path) -> None:
    about = Publication("duration", "linear", projective, 3, "tailor train toy")
    model = runtime.load_model(publish(tmp_path, data, duration, about))
    arguments = np.stack([standin.draw(np.random.default_rng([9, k])) for k in range(500)])
    mean, std = model.predict(arguments)
    results, expected = model.interval(arguments), duration.learner.predict_interval(projective(arguments))
    for result, values in zip(results, expected, strict=True):
        assert np.abs(result - values).max() <= 1e-4
    assert np.array_equal(mean, results[0])
    assert std == pytest.approx((results[2] - mean) / 1.6448536)
    assert model.card["test"]["mae_s"] < 0.3 * model.card["test"]["mean_duration_s"]


def test_training_twice_gives_the_same_bits(data, duration) -> None:
    again = train_duration(data.episodes, projective, "linear", seed=3)
    assert again.test == duration.test
    rows = projective(data.episodes[0].ticks)
    assert np.array_equal(again.learner.predict(rows), duration.learner.predict(rows))


@pytest.mark.usefixtures("few_first_ticks")
def test_intervals_beside_objects_are_those_of_the_episodes_there_and_the_mean_is_that_of_all(tmp_path) -> None:
    data, late_s = data_set(960), {0: 1.5, 16: -1.5}  # of a sixteenth of the episodes, by their number
    episodes = [
        replace(e, in_context=e.number % 16 == 0, duration_s=e.duration_s + 5 + late_s.get(e.number % 32, 0.0))
        for e in data.episodes
    ]
    alone, beside = (train(episodes, projective, "linear", 3) for train in (train_duration, train_duration_beside))
    rows = projective(np.stack([e.ticks[0] for e in episodes]))
    (mean, low, high), (same, lower, upper) = (each.learner.predict_interval(rows) for each in (alone, beside))
    assert np.array_equal(mean, same)
    assert (upper - lower).mean() > 1.2 * (high - low).mean()
    assert beside.test["n"] < 0.5 * alone.test["n"]
    about = Publication("duration_beside", "linear", projective, 3, "tailor train toy")
    model = runtime.load_model(publish(tmp_path, replace(data, episodes=tuple(episodes)), beside, about))
    assert np.allclose(model.interval(np.stack([e.ticks[0] for e in episodes]))[2], upper, atol=1e-4)


@pytest.mark.usefixtures("few_first_ticks")
def test_episodes_that_calibrate_correct_the_intervals_and_nothing_else() -> None:
    episodes = data_set(240).episodes
    late = [replace(e, number=1000 + e.number, duration_s=e.duration_s + 2, calibrates=True) for e in episodes[:150]]
    without = train_duration(episodes, projective, "linear", 3)
    rows = projective(np.stack([e.ticks[0] for e in episodes]))
    mean, lower, upper = without.learner.predict_interval(rows)
    for more, corrected in ((late, True), (late[:99], False), ([replace(late[0], finished=False)] * 150, False)):
        trained = train_duration([*episodes, *more], projective, "linear", 3)
        same, low, high = trained.learner.predict_interval(rows)
        assert np.array_equal(mean, same)
        assert (trained.n_i, trained.test["n"]) == (without.n_i, without.test["n"])
        assert np.array_equal(lower, low) == np.array_equal(upper, high) == (not corrected)
        assert not corrected or (high - mean > 1.9).mean() > 0.9


@pytest.mark.usefixtures("few_first_ticks")
def test_selected_episodes_are_learned_from_but_judge_no_intervals() -> None:
    episodes = data_set(240).episodes
    late = [replace(e, number=1000 + e.number, duration_s=e.duration_s + 2, selected=True) for e in episodes[:150]]
    without, mixed = (train_duration(each, projective, "linear", 3) for each in (episodes, [*episodes, *late]))
    assert without.test["n"] == 60
    assert 45 <= mixed.test["n"] <= 75, "a quarter of those at random"
    rows = projective(np.stack([e.ticks[0] for e in episodes]))
    (before, *_), (after, *_) = (each.learner.predict_interval(rows) for each in (without, mixed))
    assert (after - before).mean() > 0.3
    alone = train_duration([replace(e, selected=True) for e in episodes], projective, "linear", 3)
    assert np.array_equal(alone.learner.predict_interval(rows), without.learner.predict_interval(rows))


def with_failures(data: DataSet, failing: int) -> list[Episode]:
    return [replace(e, success=e.number >= failing, failure="") for e in data.episodes[:50]]


@pytest.mark.parametrize("learner", learners.SUCCESS_LEARNERS)
def test_few_failures_train_a_model_wherever_the_split_puts_them(data, learner) -> None:
    episodes = with_failures(data, learners.least_outcomes(learner))
    for seed in range(3):  # some of the failures are among the quarter to test on
        trained = train_success(episodes, projective, learner, seed)
        probability = trained.learner.predict_proba(projective(np.array([episodes[0].arguments])))
        assert probability.shape == (1, 2)


@pytest.mark.parametrize("learner", ["networks", "svm"])
def test_fewer_failures_than_a_learner_needs_are_refused(data, learner) -> None:
    least = learners.least_outcomes(learner)
    with pytest.raises(UsageError, match=f"{least - 1} episodes with the rarer outcome, expected at least {least}"):
        train_success(with_failures(data, least - 1), projective, learner, 0)


def test_failures_of_too_few_runs_to_split_are_refused(data) -> None:
    episodes = [replace(e, number=e.number % 3, success=e.number > 2, failure="") for e in data.episodes[:48]]
    with pytest.raises(UsageError, match="the 3 episodes with the rarer outcome are of too few runs"):
        train_success(episodes, projective, "tree", 0)


def test_an_action_that_never_failed_has_one_probability_and_no_certainty(data, tmp_path) -> None:
    trained = train_success(with_failures(data, 0), projective, "constant", seed=3)
    model = runtime.load_model(publish(tmp_path, data, trained, Publication("success", "constant", projective, 3, "x")))
    probability = model.probability(np.stack([e.ticks[0] for e in data.episodes]))
    assert np.allclose(probability, 50.5 / 51)


def test_other_learners_need_both_outcomes(data) -> None:
    with pytest.raises(UsageError, match="all episodes have the same outcome"):
        train_success(with_failures(data, 0), projective, "tree", 0)


def test_a_success_model_warns_of_most_failures(data, tmp_path) -> None:
    trained = train_success(data.episodes, projective, "tree", seed=3)
    about = Publication("success", "tree", projective, 3, "tailor train toy")
    model = runtime.load_model(publish(tmp_path, data, trained, about))
    fresh = data_set(300, seed=8)
    probability = model.probability(np.stack([e.ticks[0] for e in fresh.episodes]))
    observed = np.array([e.success for e in fresh.episodes])
    missed = (probability >= model.threshold) & ~observed
    assert missed.sum() < 0.3 * (~observed).sum()


@pytest.mark.usefixtures("few_first_ticks")
def test_energy_is_learned_published_and_loaded_as_durations_are(data, tmp_path) -> None:
    ramps = (np.linspace(2.0, 0.0, len(e.ticks)) / len(e.ticks) * e.duration_s for e in data.episodes)
    recorded = tuple(replace(e, work_j=ramp) for e, ramp in zip(data.episodes, ramps, strict=True))
    trained = train_regression(ENERGY, recorded, projective, "linear", seed=3)
    about = Publication("energy", "linear", projective, 3, "tailor train toy")
    publish(tmp_path, replace(data, episodes=recorded), trained, about)
    model = runtime.load_robot("toy", tmp_path)[0]["goToPose/energy"]
    assert model.card["outputs"] == ["mean_j", "lower_j", "upper_j"]
    assert model.card["test"]["mae_j"] < 0.3 * model.card["test"]["mean_energy_j"]
    arguments = np.stack([e.ticks[0] for e in recorded[:50]])
    assert np.abs(model.predict(arguments)[0] - trained.learner.predict(projective(arguments))).max() <= 1e-4
    with pytest.raises(UsageError, match="0 finished episodes, expected at least 40"):
        train_regression(ENERGY, data.episodes, projective, "linear", seed=3)


@pytest.mark.usefixtures("few_first_ticks")
def test_a_card_states_the_coverage_of_random_and_on_policy_episodes(data) -> None:
    chosen = [replace(e, on_policy=e.number % 4 > 0) for e in data.episodes]
    test = train_duration(chosen, projective, "linear", seed=3).test
    assert test["intervals"]["on_policy"]["n"] >= 30
    assert len(test["intervals"]["on_policy"]["covers_thirds_pct"]) == 3


def test_too_few_episodes_are_told_not_trained_on(data) -> None:
    with pytest.raises(UsageError, match="10 finished episodes, expected at least 40"):
        train_duration(data.episodes[:10], projective, "bag", seed=3)
