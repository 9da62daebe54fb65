"""Robust leaves: a few wild durations do not bend them, and without any they are what least squares gives."""

import numpy as np
import pytest

from tailor.models.training import learners
from tailor.models.trees.model_tree import BaggedModelTrees
from tailor.models.trees.robust_fit import refit

SLOPES = np.array([1.0, -0.5, 0.25])


def plane(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    x = rng.normal(size=(count, 2))
    return x, np.column_stack([x, np.ones(count)]) @ SLOPES + rng.normal(0, 0.05, count)


def least_squares(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.linalg.lstsq(np.column_stack([x, np.ones(len(x))]), y, rcond=None)[0]


def test_normal_errors_change_next_to_nothing() -> None:
    x, y = plane(np.random.default_rng(1), 400)
    start = least_squares(x, y)
    assert refit(x, y, np.ones(400), start, 1e-6, 1.345) == pytest.approx(start, abs=0.01)


def test_one_wild_row_in_ten_does_not_bend_the_plane() -> None:
    x, y = plane(np.random.default_rng(2), 400)
    y[:40] += 5.0
    start = least_squares(x, y)
    found = refit(x, y, np.ones(400), start, 1e-6, 1.345)
    assert abs(start - SLOPES).max() > 0.3
    assert abs(found - SLOPES).max() < 0.05


def test_rows_that_do_not_count_are_as_if_they_were_not_there() -> None:
    x, y = plane(np.random.default_rng(3), 300)
    weights = np.repeat([1.0, 0.0], [200, 100])
    start = least_squares(x[:200], y[:200])
    alone = refit(x[:200], y[:200], np.ones(200), start, 1e-6, 50.0)
    assert refit(x, y, weights, start, 1e-6, 50.0) == pytest.approx(alone, abs=1e-6)


def test_the_robust_learner_errs_less_where_durations_have_a_long_tail() -> None:
    rng = np.random.default_rng(4)
    x = rng.uniform(0, 4, (1600, 3))
    y = 1.0 + x[:, 0] + np.abs(x[:, 1] - 2) + np.where(rng.random(1600) < 0.1, rng.exponential(8.0, 1600), 0.0)
    plain = BaggedModelTrees(random_state=1).fit(x[:1200], y[:1200])
    robust = learners.make_learner("duration", "robust", 1).fit(x[:1200], y[:1200])
    error = [np.abs(model.predict(x[1200:]) - y[1200:]).mean() for model in (plain, robust)]
    assert error[1] < 0.95 * error[0]
