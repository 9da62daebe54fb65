"""Bounds of models with prediction intervals hold."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.models.bounds.interval_boxes import UPPER_SCORE
from tailor.models.bounds.model_bounds import model_bounds
from tailor.models.export.onnx_export import export_duration
from tailor.models.features.planar import projective
from tailor.models.inference import open_session
from tailor.models.regression import network_training
from tailor.models.regression.blend import BlendedRegressor
from tailor.models.regression.calibrated import CalibratedRegressor
from tailor.models.trees.regression_model import RegressionModel

SHAPE = (1, 1, 1)
LIMITS = np.array([[-3.5, -2.25, -np.pi, 0] * 2, [3.5, 2.25, np.pi, 0.6] * 2])


BLENDS = [
    {"bag": 1.0},
    {"network": 1.0},
    {"deep-network": 1.0},
    {"bag": 0.4, "network": 0.6},
    {"network": 0.9, "bag": 0.1},
]


def examples() -> tuple[np.ndarray, np.ndarray]:
    """Features (n, 5) and seconds (n,)."""
    rng = np.random.default_rng(1)
    features = projective(rng.uniform(*LIMITS, (600, 8)))
    seconds = 1 + features[:, 2] + np.abs(features[:, 4]) + (0.05 + features[:, 3] ** 2) * rng.exponential(0.3, 600)
    return features, seconds


def exported(learner: RegressionModel):
    """Session and bounds of a learner, fitted in short."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(network_training, "STEPS", 200)
        content = export_duration(learner.fit(*examples()), projective, {}).SerializeToString()
    return open_session(content), model_bounds(content, "projective", 5)


@pytest.fixture(scope="module", params=BLENDS, ids=str)
def model(request):
    return exported(CalibratedRegressor(BlendedRegressor(weights=request.param)))


@pytest.fixture(scope="module", params=BLENDS, ids=str)
def model_without_intervals(request):
    return exported(BlendedRegressor(weights=request.param))


def drawn_box(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, tuple[tuple[np.ndarray, ...], ...]]:
    """Rows of arguments in a box, its sizes, and its ends."""
    lower = rng.uniform(*LIMITS)
    size = (LIMITS[1] - lower) * rng.choice([0.0, 1e-4, 0.05, 0.5], 8)
    rows = lower + rng.choice([0.0, 0.5, 1.0], (300, 8)) * size
    return rows, size, tuple(tuple(np.full(SHAPE, value) for value in side) for side in (lower, lower + size))


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 1.0, UPPER_SCORE, 3.0]))
def test_no_prediction_lies_below_its_bound(model, seed, k_std) -> None:
    session, bounds = model
    rows, _, ends = drawn_box(np.random.default_rng(seed))
    mean, _, end = (values.astype(float) for values in session.run(None, {"arguments": rows}))
    assert bounds.upper_bound(*ends).item() >= mean.max()
    for bound in (bounds, bounds.within(*ends)):
        assert bound.lower_bound(*ends, k_std).item() <= (mean + k_std * (end - mean) / UPPER_SCORE).min()


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 1.0, 3.0]))
def test_no_prediction_of_a_model_without_intervals_lies_below_its_bound(model_without_intervals, seed, k_std) -> None:
    session, bounds = model_without_intervals
    rows, size, ends = drawn_box(np.random.default_rng(seed))
    mean, std = (values.astype(float) for values in session.run(None, {"arguments": rows}))
    least = (mean + k_std * std).min()
    for bound in (bounds, bounds.within(*ends)):
        assert bound.lower_bound(*ends, k_std).item() <= least
        if bound.is_linear:
            radius = tuple(np.full(SHAPE, half) for half in size / 2)
            middle, slopes = bound.linear_bound(*ends, radius, k_std)
            reach = sum(np.abs(slope).item() * size[j] / 2 for j, slope in slopes.items())
            assert middle.item() - reach <= least


def test_the_bound_includes_the_spread(model) -> None:
    _, bounds = model
    point = tuple(np.full(SHAPE, value) for value in (0.0, 0.0, 0.0, 0.0, 2.0, 1.0, 0.5, 0.0))
    assert bounds.lower_bound(point, point, 1.0).item() > bounds.lower_bound(point, point, 0.0).item() + 0.01
