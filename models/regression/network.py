"""A mean of small neural networks as a regressor: smooth where trees have steps (paper 8)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from sklearn.utils.validation import check_is_fitted, validate_data
from threadpoolctl import threadpool_limits

from tailor.models.regression.network_training import Networks, train
from tailor.models.trees.regression_model import RegressionModel

Floats = NDArray[np.float32]
Array = NDArray[np.float64]

# Of networks that take as long as those of the usual shape. They follow jumps better, but are less easily bounded.
DEEP: Mapping[str, int] = {"depth": 3, "width": 48}
MIN_SCALE = 1e-9  # of targets that do not vary
MIN_SHARE = 1e-5  # of a feature's largest value: one that varies by less is constant but for single precision


@dataclass(frozen=True, slots=True)
class Layer:
    """One layer of k networks: `weights @ x + bias`, rectified but in the last layer."""

    weights: Floats  # (k, out, in)
    bias: Floats  # (k, out, 1)


class NetworkRegressor(RegressionModel):
    """The mean of networks with rectified hidden layers, clipped to the range of the training targets.

    Args:
      networks: Number of networks; they differ by initial weights and batches.
      depth: Hidden layers.
      width: Neurons in each of them.
      decay: Decay of the weights, see `network_training.train`.
      random_state: Seed of weights and batches.
    """

    def __init__(
        self, networks: int = 4, depth: int = 2, width: int = 64, decay: float = 0.3, random_state: int = 0
    ) -> None:
        self.networks = networks
        self.depth = depth
        self.width = width
        self.decay = decay
        self.random_state = random_state

    def fit(self, X: Any, y: Any, groups: Any = None) -> Self:
        """Fit to features (n, f) and seconds (n,); groups are ignored.

        Raises:
          ValueError: The rows are not finite numbers.
        """
        X, y = validate_data(self, X, y, y_numeric=True, dtype=np.float64)
        centre, scale = X.mean(axis=0), _scale(X)
        mean, spread = float(y.mean()), max(float(y.std()), MIN_SCALE)
        rows, targets = ((X - centre) / scale).astype(np.float32), ((y - mean) / spread).astype(np.float32)
        rng = np.random.default_rng(self.random_state)
        with threadpool_limits(1):  # two threads wait for each other on small products, and may sum in another order
            fitted = train(rows, targets, self.networks, (self.width,) * self.depth, self.decay, rng)
        self.layers_ = _unscaled(fitted, centre, scale, mean, spread)
        self.low_, self.high_ = np.float32(y.min()), np.float32(y.max())
        return self

    def predict_with_std(self, X: Any) -> tuple[Floats, Floats]:
        """Seconds and the standard deviation over the networks, shapes (n,)."""
        check_is_fitted(self)
        rows = np.asarray(validate_data(self, X, dtype=np.float64, reset=False), np.float32).T
        for layer in self.layers_[:-1]:
            rows = np.maximum(layer.weights @ rows + layer.bias, np.float32(0))
        each = (self.layers_[-1].weights @ rows + self.layers_[-1].bias)[:, 0]
        return np.clip(each.mean(axis=0), self.low_, self.high_), each.std(axis=0)


def _scale(X: Array) -> Array:
    """Standard deviation of each feature, (f,); 1 of one that does not vary, whose weights would grow to millions."""
    deviation = X.std(axis=0)
    return np.where(deviation > MIN_SHARE * np.abs(X).max(axis=0), deviation, 1.0)


def _unscaled(fitted: Networks, centre: Array, scale: Array, mean: float, spread: float) -> tuple[Layer, ...]:
    """The layers, with the scaling of features and targets merged into the first and the last one."""
    weights = [w.transpose(0, 2, 1).astype(np.float64) for w, _ in fitted.layers]
    bias = [b.transpose(0, 2, 1).astype(np.float64) for _, b in fitted.layers]
    weights[0] = weights[0] / scale
    bias[0] = bias[0] - weights[0] @ centre[:, None]
    weights[-1], bias[-1] = weights[-1] * spread, bias[-1] * spread + mean
    return tuple(Layer(w.astype(np.float32), b.astype(np.float32)) for w, b in zip(weights, bias, strict=True))
