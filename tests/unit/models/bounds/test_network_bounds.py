"""Bounds of networks hold for any weights, and are close to the minimum in small boxes."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.models.bounds import network_bounds
from tailor.models.bounds.network_bounds import NetworkBounds
from tailor.models.features.intervals import Span

FEATURES = 3


def drawn_networks(rng: np.random.Generator, networks: int = 3, width: int = 8, hidden: int = 2) -> NetworkBounds:
    """Networks of random weights, a few of them zero; the mean is hardly ever clipped."""
    sizes = ((width, FEATURES), *[(width, width)] * (hidden - 1), (1, width))
    weights = tuple(
        (rng.normal(0, 1.5 / np.sqrt(size[1]), (networks, *size)) * (rng.random((networks, *size)) < 0.9)).astype("f4")
        for size in sizes
    )
    bias = tuple(rng.normal(0, 0.7, (networks, size[0], 1)).astype(np.float32) for size in sizes)
    return NetworkBounds(weights, bias, -3.0, 20.0)


def outputs(bounds: NetworkBounds, rows: np.ndarray) -> np.ndarray:
    """Output of each network, shape (k, n), for features (f, n), in double precision."""
    for weights, bias in zip(bounds.weights[:-1], bounds.bias[:-1], strict=True):
        rows = np.maximum(weights.astype(float) @ rows + bias, 0)
    return (bounds.weights[-1].astype(float) @ rows + bounds.bias[-1])[:, 0]


def predicted(bounds: NetworkBounds, rows: np.ndarray) -> np.ndarray:
    """The clipped mean, shape (n,), of features (f, n)."""
    return np.clip(outputs(bounds, rows).mean(axis=0), bounds.low, bounds.high)


def spans(lower: np.ndarray, upper: np.ndarray) -> tuple[Span, ...]:
    """Spans of n boxes, (n, f)."""
    return tuple(Span(lower[:, j].reshape(1, 1, -1), upper[:, j].reshape(1, 1, -1)) for j in range(FEATURES))


def extreme(
    bounds: NetworkBounds, lower: np.ndarray, upper: np.ndarray, rng: np.random.Generator
) -> tuple[float, float]:
    """Smallest and largest mean found in a box, (f,): at random points and corners, and around the best of them."""
    ends = []
    for sign in (1, -1):
        at = lower + rng.choice([0.0, 0.5, 1.0, 0.2, 0.9], (400, FEATURES)) * (upper - lower)
        for scale in (0.3, 0.1, 0.03, 0.01):
            best = at[np.argmin(sign * predicted(bounds, at.T))]
            steps = best + scale * rng.normal(size=(200, FEATURES)) * (upper - lower)
            at = np.vstack([best, np.clip(steps, lower, upper)])
        ends.append(float(predicted(bounds, at.T)[np.argmin(sign * predicted(bounds, at.T))]))
    return ends[0], ends[1]


@settings(max_examples=200, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 1e-4, 0.1, 1.0, 5.0]))
def test_no_network_leaves_its_bounds(seed, size):
    rng = np.random.default_rng(seed)
    bounds = drawn_networks(rng, hidden=int(rng.integers(1, 4)))
    lower = rng.uniform(-3, 3, FEATURES)
    upper = lower + size * rng.choice([0.0, 0.5, 1.0], FEATURES)
    least, most = extreme(bounds, lower, upper, rng)
    box = spans(lower[None], upper[None])
    assert bounds.least(box).item() <= least
    assert -bounds.least(box, sign=-1).item() >= most


def test_many_boxes_are_bounded_as_each_alone():
    rng = np.random.default_rng(5)
    bounds = drawn_networks(rng)
    lower = rng.uniform(-3, 3, (2 * network_bounds.CHUNK + 3, FEATURES))
    upper = lower + rng.uniform(0, 1, lower.shape)
    together = bounds.least(spans(lower, upper)).ravel()
    apart = [bounds.least(spans(lower[i : i + 1], upper[i : i + 1])).item() for i in range(len(lower))]
    np.testing.assert_allclose(together, apart, atol=1e-4)


def test_bounds_are_close_to_the_minimum_in_small_boxes():
    rng = np.random.default_rng(6)
    excess = []
    for _ in range(40):
        bounds = drawn_networks(rng)
        lower = rng.uniform(-2, 2, FEATURES)
        upper = lower + 0.5
        least, most = extreme(bounds, lower, upper, rng)
        excess.append((least - bounds.least(spans(lower[None], upper[None])).item()) / max(most - least, 0.01))
    assert np.mean(excess) < 0.15  # of the range of predictions; 0.23 if each neuron is bounded apart


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 1e-4, 5e-3, 0.9 * network_bounds.WIDE, 0.1, 1.0, 5.0]))
def test_no_standard_deviation_over_the_networks_leaves_its_bounds(seed, size):
    rng = np.random.default_rng(seed)
    bounds = drawn_networks(rng, hidden=int(rng.integers(1, 4)))
    lower = rng.uniform(-3, 3, FEATURES)
    upper = lower + size * rng.random(FEATURES)
    inside = lower + rng.choice([0.0, 0.5, 1.0, 0.2], (400, FEATURES)) * (upper - lower)
    std = outputs(bounds, inside.T).std(axis=0)
    span = bounds.deviation(spans(lower[None], upper[None]))
    assert span.lower.item() <= std.min()
    assert std.max() <= span.upper.item()
    assert size > network_bounds.WIDE or np.isfinite(span.upper.item())
    if size == 0.0:
        assert span.upper.item() - span.lower.item() < 1e-3, "at a point it is known but for rounding"


def test_deviations_in_narrow_boxes_among_wide_ones_are_bounded_as_each_alone():
    rng = np.random.default_rng(7)
    bounds = drawn_networks(rng)
    lower = rng.uniform(-3, 3, (3 * network_bounds.CHUNK, FEATURES))
    upper = lower + rng.choice([0.1, 5.0], (len(lower), 1)) * network_bounds.WIDE
    together = bounds.deviation(spans(lower, upper))
    apart = [bounds.deviation(spans(lower[i : i + 1], upper[i : i + 1])) for i in range(len(lower))]
    np.testing.assert_allclose(together.lower.ravel(), [each.lower.item() for each in apart], atol=1e-4)
    np.testing.assert_allclose(together.upper.ravel(), [each.upper.item() for each in apart], atol=1e-4)
