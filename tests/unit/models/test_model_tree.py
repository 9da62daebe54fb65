"""Model trees: scikit-learn's contract, and what learning.md promises of them."""

import numpy as np
import pytest
from sklearn.utils.estimator_checks import check_estimator

from tailor.models.failure.distilled_forest import DistilledForest
from tailor.models.failure.distilled_tree import DistilledFailureTree
from tailor.models.failure.failure_forest import FailureForest
from tailor.models.failure.failure_tree import FailureTree
from tailor.models.trees.distillation import DistilledModelTree
from tailor.models.trees.model_tree import BaggedModelTrees, ModelTreeRegressor

ESTIMATORS = [
    ModelTreeRegressor(),
    ModelTreeRegressor("m5"),
    BaggedModelTrees(trees=2),
    FailureTree(),
    FailureForest(trees=5),
    DistilledForest(trees=3, rounds=20),
    DistilledFailureTree(trees=5),
    DistilledModelTree(trees=2),
]


@pytest.mark.parametrize("estimator", ESTIMATORS, ids=lambda e: f"{type(e).__name__}-{getattr(e, 'variant', '')}")
@pytest.mark.filterwarnings("ignore")
def test_estimators_keep_the_contract_of_scikit_learn(estimator) -> None:
    check_estimator(estimator)


def two_planes(count: int, seed: int = 0, noise: float = 0.01):
    """Seconds that jump and bend at x0 = 0.3."""
    rng = np.random.default_rng(seed)
    x = rng.uniform(-1, 1, (count, 3))
    y = np.where(x[:, 0] <= 0.3, 3 + 2 * x[:, 1], 6 - 1.5 * x[:, 2])
    return x, y + rng.normal(0, noise, count)


@pytest.mark.parametrize("variant", ["linear", "m5"])
def test_two_planes_are_found_again(variant: str) -> None:
    x, y = two_planes(3000)
    fresh, seconds = two_planes(1000, seed=1, noise=0)
    tree = ModelTreeRegressor(variant, smoothing=0.0).fit(x, y)
    away = np.abs(fresh[:, 0] - 0.3) > 0.05
    assert np.abs(tree.predict(fresh) - seconds)[away].mean() < 0.03
    if variant == "linear":
        assert abs(tree.tree_.splits.threshold[0] - 0.3) < 0.05


def test_no_leaf_leaves_what_was_seen_in_it() -> None:
    x, y = two_planes(2000)
    far = np.random.default_rng(2).uniform(-50, 50, (2000, 3))
    for learner in (ModelTreeRegressor(), BaggedModelTrees(trees=3)):
        seconds = learner.fit(x, y).predict(far)
        assert seconds.min() >= y.min() - 1e-5
        assert seconds.max() <= y.max() + 1e-5


def test_one_noisy_episode_repeated_often_makes_no_leaves() -> None:
    """Rows of one episode are near copies: sizing on rows would split them apart, sizing on episodes does not."""
    rng = np.random.default_rng(0)
    x = np.repeat(rng.uniform(-1, 1, (100, 2)), 30, axis=0) + rng.normal(0, 1e-3, (3000, 2))
    y = np.repeat(x[::30, 0] + rng.normal(0, 0.5, 100), 30)
    groups = np.repeat(np.arange(100), 30)
    settings = {"min_rows": 8.0, "max_leaves": 64}
    by_episode = ModelTreeRegressor(**settings).fit(x, y, groups=groups).tree_.leaves
    by_row = ModelTreeRegressor(**settings).fit(x, y).tree_.leaves
    assert by_episode <= 4 < by_row


def test_a_bag_is_less_sure_where_it_has_not_looked() -> None:
    x, y = two_planes(600, noise=0.3)
    bag = BaggedModelTrees(trees=8).fit(x, y)
    spread = bag.predict_with_std(two_planes(600, seed=3)[0])[1]
    edge = np.abs(two_planes(600, seed=3)[0][:, 0] - 0.3) < 0.05
    assert spread[edge].mean() > 2 * spread[~edge].mean()


def test_costly_failures_make_the_tree_pessimistic() -> None:
    rng = np.random.default_rng(0)
    x = rng.uniform(-1, 1, (3000, 2))
    y = (rng.uniform(size=3000) < 1 / (1 + np.exp(-6 * x[:, 0]))).astype(int)
    shy, bold = FailureTree(cost_ratio=8).fit(x, y), FailureTree(cost_ratio=1).fit(x, y)
    missed = [np.mean((model.predict(x) == 1) & (y == 0)) for model in (shy, bold)]
    assert missed[0] < 0.5 * missed[1]


def test_probabilities_mean_what_they_say() -> None:
    rng = np.random.default_rng(0)
    x = rng.uniform(-1, 1, (6000, 2))
    y = (rng.uniform(size=6000) < 1 / (1 + np.exp(-4 * x[:, 0]))).astype(int)
    for model in (FailureTree(cost_ratio=5), FailureForest(cost_ratio=5, min_rows=20)):
        said = model.fit(x[:4000], y[:4000]).predict_proba(x[4000:])[:, 1]
        for low in (0.0, 0.25, 0.5, 0.75):
            part = (said >= low) & (said < low + 0.25)
            if part.sum() > 50:
                assert abs(said[part].mean() - y[4000:][part].mean()) < 0.08


def test_a_distilled_tree_says_what_its_teacher_says() -> None:
    x, y = two_planes(1500, noise=0.3)
    settings = {"min_rows": 20.0, "random_state": 1}
    bag, pupil = BaggedModelTrees(trees=5, **settings).fit(x, y), DistilledModelTree(trees=5, **settings).fit(x, y)
    fresh = two_planes(500, seed=5)[0]
    assert np.abs(bag.predict(fresh) - pupil.predict(fresh)).mean() < 0.1


def test_a_distilled_forest_does_not_learn_failures_by_heart_that_nothing_explains() -> None:
    rng = np.random.default_rng(3)
    x, success = rng.uniform(-1, 1, (2000, 4)), rng.random(2000) > 0.01
    predicted = DistilledForest(random_state=1).fit(x, success).predict_proba(x)[:, 1]
    assert abs(predicted.mean() - success.mean()) < 0.005
    assert predicted.min() > 0.9


def test_a_distilled_forest_learns_many_failures_as_sharply_as_they_are() -> None:
    x = np.random.default_rng(3).uniform(-1, 1, (3000, 4))
    fresh = np.random.default_rng(4).uniform(-1, 1, (1000, 4))
    forest = DistilledForest(random_state=1).fit(x, np.abs(x[:, 0]) + np.abs(x[:, 1]) < 1)
    assert (forest.predict(fresh) == (np.abs(fresh[:, 0]) + np.abs(fresh[:, 1]) < 1)).mean() > 0.95
