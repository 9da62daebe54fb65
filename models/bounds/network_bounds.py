"""Lower bounds of a mean of networks over boxes of features, by linear relaxation (CROWN, Zhang et al. 2018).

Each rectifier lies between two lines over the range of its input. Propagated back, they give a linear lower bound of
the mean of all networks, which is minimised over the box: far tighter than the sum of each neuron's minimum.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.leaf_bounds import FARTHEST, ROUNDING
from tailor.models.bounds.onnx_reader import Contents
from tailor.models.features.intervals import Span
from tailor.models.trees import tree_names

Floats = NDArray[np.float32]
LAYERS = 3
OPERATIONS = 10  # for each neuron of a network, about


@dataclass(frozen=True)
class NetworkBounds:
    """The bounds of the mean of k networks with two rectified hidden layers, clipped to [low, high]."""

    weights: tuple[Floats, ...]  # of each layer, (k, out, in)
    bias: tuple[Floats, ...]  # (k, out, 1)
    low: float
    high: float
    trees_share: float = 0.0  # weight of the trees that the networks are blended with

    @property
    def effort(self) -> int:
        """Approximate number of elementary operations for one bound."""
        return int(OPERATIONS * sum(layer.shape[0] * layer.shape[1] for layer in self.weights))

    def least(self, features: tuple[Span, ...], sign: int = 1) -> Floats:
        """Lower bound of `sign` times the mean, of the shape that the spans broadcast to."""
        shape = np.broadcast_shapes(*(np.shape(span.lower) for span in features))
        lower, upper = (
            np.stack([np.broadcast_to(end, shape).ravel() for end in ends]).astype(np.float32)
            for ends in zip(*((span.lower, span.upper) for span in features), strict=True)
        )
        half = np.float32(0.5)
        bound = self._linear_bound(half * (lower + upper), half * (upper - lower), np.float32(sign))
        low, high = sorted((sign * self.low, sign * self.high))
        clipped: Floats = np.clip(bound - np.float32(self.slack), np.float32(low), np.float32(high))
        return clipped.reshape(shape)

    @cached_property
    def slack(self) -> float:
        """Bound of the rounding error of single precision, here and in the model."""
        size = np.full((1, self.weights[0].shape[2], 1), FARTHEST)
        for weights, bias in zip(self.weights, self.bias, strict=True):
            size = np.abs(weights) @ size + np.abs(bias)
        return 4 * ROUNDING * float(size.mean())

    def _linear_bound(self, middle: Floats, radius: Floats, sign: np.float32) -> Floats:
        """Minimum of the linear lower bound over boxes (f, n), shape (n,)."""
        (w1, w2, w3), (b1, b2, b3) = self.weights, self.bias
        first = _Rectified(w1 @ middle + b1, np.abs(w1) @ radius)
        low, high = (np.maximum(end, 0) for end in (first.lower, first.upper))
        second = _Rectified(w2 @ ((low + high) / 2) + b2, np.abs(w2) @ ((high - low) / 2))
        factor = sign / np.float32(len(w3)) * w3.transpose(0, 2, 1)  # (k, h, 1)
        constant = sign * b3.mean() + second.constant(factor)
        factor = second.slopes(factor)
        constant = constant + (factor * b2).sum(axis=(0, 1))
        factor = w2.transpose(0, 2, 1) @ factor
        constant = constant + first.constant(factor)
        factor = first.slopes(factor)
        constant = constant + (factor * b1).sum(axis=(0, 1))
        slopes = (w1.transpose(0, 2, 1) @ factor).sum(axis=0)  # (f, n), of all networks together
        bound: Floats = constant + (slopes * middle).sum(axis=0) - (np.abs(slopes) * radius).sum(axis=0)
        return bound


class _Rectified:
    """Lines below and above max(x, 0) for inputs `middle ± radius`, (k, h, n)."""

    def __init__(self, middle: Floats, radius: Floats) -> None:
        self.lower, self.upper = middle - radius, middle + radius
        crossing = (self.lower < 0) & (self.upper > 0)
        active = self.lower >= 0
        chord = self.upper / np.maximum(self.upper - self.lower, np.float32(1e-12))
        self._above = np.where(crossing, chord, active.astype(np.float32))
        self._offset = np.where(crossing, -chord * self.lower, np.float32(0))
        self._below = np.where(crossing, self.upper > -self.lower, active).astype(np.float32)

    def slopes(self, factor: Floats) -> Floats:
        """Factors of the inputs for a lower bound of `factor` times the outputs."""
        return factor * np.where(factor >= 0, self._below, self._above)

    def constant(self, factor: Floats) -> Floats:
        """Sum of the offsets of that bound, shape (n,)."""
        total: Floats = (np.minimum(factor, 0) * self._offset).sum(axis=(0, 1))
        return total


def network_bounds(graph: Contents) -> NetworkBounds | None:
    """Bounds of the networks of an ONNX model; None if it has none."""
    if tree_names.NETWORK_LOW not in graph.constants:
        return None
    weights, bias = (
        tuple(np.asarray(graph.constants[name.format(layer)], np.float32) for layer in range(LAYERS))
        for name in (tree_names.NETWORK_WEIGHTS, tree_names.NETWORK_BIAS)
    )
    low, high = (float(graph.constants[name].ravel()[0]) for name in (tree_names.NETWORK_LOW, tree_names.NETWORK_HIGH))
    share = graph.constants.get(tree_names.MEMBER_WEIGHT.format(0))
    return NetworkBounds(weights, bias, low, high, 0.0 if share is None else float(share.ravel()[0]))
