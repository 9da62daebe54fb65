"""Linear bounds hold for any networks, also where the mean of the networks is clipped in some of the copies."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.models.bounds.linear_bounds import linear_bound
from tailor.models.bounds.network_bounds import NetworkBounds
from tailor.models.features.spaces import feature_space

COPIES = 4
FREE = (2, 3, 6, 7)  # arguments that vary: angles and speeds; the others are known


def drawn_networks(rng: np.random.Generator, features: int) -> NetworkBounds:
    """Networks of random weights whose mean is often clipped."""
    sizes = ((8, features), (8, 8), (1, 8))
    weights = tuple(rng.normal(0, 1.5 / np.sqrt(size[1]), (3, *size)).astype(np.float32) for size in sizes)
    bias = tuple(rng.normal(0, 0.7, (3, size[0], 1)).astype(np.float32) for size in sizes)
    low = float(rng.uniform(-2, 0))
    return NetworkBounds(weights, bias, low, low + float(rng.uniform(0.1, 2)))


def predicted(networks: NetworkBounds, rows: np.ndarray) -> np.ndarray:
    """The clipped mean, shape (n,), of features (n, f)."""
    values = rows.T.astype(float)
    for weights, bias in zip(networks.weights[:-1], networks.bias[:-1], strict=True):
        values = np.maximum(weights.astype(float) @ values + bias, 0)
    mean = (networks.weights[-1].astype(float) @ values + networks.bias[-1])[:, 0].mean(axis=0)
    return np.clip(mean, networks.low, networks.high)


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from(["projective", "projective-periodic", "straight-drive"]),
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.0, 0.1, 1.0]),
)
def test_no_mean_over_the_copies_lies_below_its_bound(space, seed, size):
    rng = np.random.default_rng(seed)
    features = feature_space(space)
    count = len(features.arguments)
    moved = rng.normal(0, 1.0, (COPIES, count)) * rng.choice([0.0, 0.1, 1.0])
    middle = rng.uniform(-3, 3, count)
    radius = size * rng.uniform(0, 1, count)
    radius[[j for j in range(count) if j not in FREE]] = 0.0
    networks = drawn_networks(rng, features(middle[None]).shape[1])
    ends = (tuple((middle + moved + side * radius).T[:, :, None, None]) for side in (-1, 1))
    value, slopes = linear_bound(networks, space, *ends, tuple(radius.reshape(count, 1, 1, 1)))
    away = radius * rng.choice([-1.0, 0.0, 0.3, 1.0], (300, count))
    means = np.mean([predicted(networks, features(middle + away + each)) for each in moved], axis=0)
    linear = value.item() + sum(slope.item() * away[:, j] for j, slope in slopes.items())
    assert set(slopes) <= set(FREE)
    assert (linear <= means + 1e-5).all()
