"""Networks, blends and their choice: the best by cross-validation, within scikit-learn's interface."""

import numpy as np
import pytest
from sklearn.base import clone

from tailor.models.regression import blend, network_training
from tailor.models.regression.blend import BlendedRegressor
from tailor.models.regression.calibrated import CalibratedRegressor
from tailor.models.regression.network import NetworkRegressor
from tailor.models.training.learners import make_learner


@pytest.fixture(autouse=True)
def brief(monkeypatch) -> None:
    monkeypatch.setattr(network_training, "STEPS", 600)


def smooth(count: int, seed: int):
    rng = np.random.default_rng(seed)
    features = rng.uniform(-2, 2, (count, 3))
    return features, 3 + np.sin(2 * features[:, 0]) * features[:, 1] + 0.05 * rng.normal(size=count)


def stepped(count: int, seed: int):
    rng = np.random.default_rng(seed)
    features = rng.uniform(-2, 2, (count, 3))
    return features, np.floor(2 * features[:, 0]) + 5.0 * (features[:, 1] > 0.3) + 0.01 * rng.normal(size=count)


@pytest.mark.parametrize(("data", "expected"), [(smooth, "network"), (stepped, "bag")])
def test_the_learner_that_errs_less_on_unseen_episodes_is_chosen(data, expected) -> None:
    features, targets = data(800, 1)
    learner = BlendedRegressor(("bag", "network"), random_state=1).fit(features, targets)
    assert learner.chosen_ == expected
    assert list(learner.members_) == [expected]
    fresh, observed = data(400, 2)
    assert np.abs(learner.predict(fresh) - observed).mean() == pytest.approx(learner.cv_mae_[expected], rel=0.35)


def test_a_costlier_learner_must_gain_enough() -> None:
    assert blend._best({"bag": 1.0, "network": 0.98, "stack": 0.975}) == "bag"
    assert blend._best({"bag": 1.0, "network": 0.9, "stack": 0.89}) == "network"
    assert blend._best({"bag": 1.0, "network": 1.2, "stack": 0.9}) == "stack"


def test_networks_of_two_shapes_can_be_chosen_from(monkeypatch) -> None:
    monkeypatch.setattr(network_training, "STEPS", 300)
    features, targets = stepped(400, 5)
    learner = make_learner("duration", "best-network", 1).fit(features, targets)
    assert list(learner.cv_mae_) == ["network", "deep-network"]
    assert learner.chosen_ == blend._best(learner.cv_mae_)
    assert learner.weights_ == {learner.chosen_: 1.0}
    monkeypatch.setattr(blend, "MIN_GAIN", -1.0)  # now any later one is chosen
    deep = make_learner("duration", "best-network", 1).fit(features, targets)
    assert [layer.weights.shape[1] for layer in deep.members_["deep-network"].layers_] == [48, 48, 48, 1]


def test_the_stack_is_a_convex_mean_and_keeps_its_weights_when_frozen() -> None:
    features, targets = smooth(400, 3)
    stack = BlendedRegressor(("stack",), random_state=1).fit(features, targets)
    assert sum(stack.weights_.values()) == pytest.approx(1)
    assert min(stack.weights_.values()) > 0
    again = stack.frozen().fit(features, targets)
    assert again.weights_ == stack.weights_
    assert not hasattr(again, "cv_mae_")
    assert np.array_equal(again.predict(features), stack.predict(features))


def test_networks_are_reproducible_and_never_leave_the_range_of_their_targets() -> None:
    features, targets = smooth(200, 4)
    one, other = (NetworkRegressor(networks=2, random_state=5).fit(features, targets) for _ in range(2))
    assert np.array_equal(one.predict(features), other.predict(features))
    far = one.predict(100 * features)
    assert targets.min() - 1e-6 <= far.min() <= far.max() <= targets.max() + 1e-6


@pytest.mark.parametrize("value", [0.0, 0.3, 1.0, -40.0])
def test_a_feature_that_does_not_vary_tells_networks_nothing(value) -> None:
    """Its weights grew to millions, beyond what single precision adds up: errors of 0.03 s became 1.6 s."""
    features, targets = smooth(400, 8)
    rng = np.random.default_rng(9)
    rounded = np.float32(value) * (1 + np.finfo(np.float32).eps * rng.integers(-1, 2, len(features)))
    plain = NetworkRegressor(networks=2, random_state=5).fit(features, targets).predict(features)
    for constant in (np.full(len(features), value), rounded):
        learner = NetworkRegressor(networks=2, random_state=5).fit(np.column_stack([features, constant]), targets)
        for known in (value, value + 0.01):
            rows = np.column_stack([features, np.full(len(features), known)])
            off, usual = (np.abs(some - targets).mean() for some in (learner.predict(rows), plain))
            assert off < 1.3 * usual + 0.02


def test_intervals_are_of_errors_on_unseen_episodes() -> None:
    """Rows of an episode are copies: a learner that knows them all by heart still has the error of a fresh one."""
    features, targets = smooth(300, 6)
    rows, values, groups = np.repeat(features, 4, axis=0), np.repeat(targets, 4), np.repeat(np.arange(300), 4)
    learner = CalibratedRegressor(BlendedRegressor(("bag",), weights={"bag": 1.0}), 1).fit(rows, values, groups=groups)
    fresh, observed = smooth(4000, 7)
    _, lower, upper = learner.predict_interval(fresh)
    assert np.mean((observed >= lower) & (observed <= upper)) == pytest.approx(0.9, abs=0.06)
    assert hasattr(clone(learner), "inner")
