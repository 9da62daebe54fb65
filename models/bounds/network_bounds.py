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
OPERATIONS = 5  # for each neuron of a network, about: they take as long as so many comparisons of leaves
CHUNK = 64  # boxes: their arrays fit into the cache


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
        middle, radius = half * (lower + upper), half * (upper - lower)
        parts = (slice(first, first + CHUNK) for first in range(0, middle.shape[1], CHUNK))
        bound = np.concatenate([self._linear_bound(middle[:, n], radius[:, n], np.float32(sign)) for n in parts])
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
        inputs = w1 @ middle + b1
        first = _Rectified(*_ends(inputs, np.abs(w1) @ radius))
        second = _Rectified(*self._second_inputs(first, inputs, radius))
        factor, constant = second.below(sign / np.float32(len(w3)) * w3.transpose(0, 2, 1))
        constant = sign * b3.mean() + constant + _total(factor, b2)
        factor, offset = first.below(w2.transpose(0, 2, 1) @ factor)
        constant += offset + _total(factor, b1)
        slopes = w1.reshape(-1, len(middle)).T @ factor.reshape(-1, middle.shape[1])  # of all networks together
        bound: Floats = constant + (slopes * middle).sum(axis=0) - (np.abs(slopes) * radius).sum(axis=0)
        return bound

    def _second_inputs(self, first: _Rectified, inputs: Floats, radius: Floats) -> tuple[Floats, Floats]:
        """Both ends of the second layer's inputs: two relaxations of the first layer, intersected.

        Each output apart lies between the ends of its range; as a function of the features it lies in a strip.
        """
        w1, w2, b2 = self.weights[0], self.weights[1], self.bias[1]
        half, size = np.float32(0.5), np.abs(w2)
        low: Floats = np.maximum(first.lower, 0)
        centre: Floats = half * (low + first.high)
        apart = _ends(w2 @ centre + b2, size @ (first.high - centre))
        width: Floats = half * first.offset
        reach: Floats = size @ width
        for feature, extent in enumerate(radius):
            slopes = w2 @ (w1[:, :, feature, None] * first.above)
            reach += np.abs(slopes, out=slopes) * extent
        strip = _ends(w2 @ (first.above * inputs + width) + b2, reach)
        return np.maximum(apart[0], strip[0]), np.minimum(apart[1], strip[1])


def _ends(middle: Floats, radius: Floats) -> tuple[Floats, Floats]:
    return middle - radius, middle + radius


def _total(factor: Floats, bias: Floats) -> Floats:
    """Sum over networks and neurons of (k, h, n) times (k, h, 1), shape (n,)."""
    total: Floats = bias.ravel() @ factor.reshape(bias.size, -1)
    return total


class _Rectified:
    """Lines below and above max(x, 0) for inputs between `lower` and `upper`, (k, h, n).

    The line above has the slope `above` and passes `offset` over 0; that below passes 0, with slope 0 or 1.
    """

    def __init__(self, lower: Floats, upper: Floats) -> None:
        self.lower = lower
        low, self.high = np.minimum(lower, 0), np.maximum(upper, 0)
        self.above = self.high / np.maximum(self.high - low, np.float32(1e-12))
        self.offset = -self.above * low
        self._steep = self.high > -low

    def below(self, factor: Floats) -> tuple[Floats, Floats]:
        """Lower bound of `factor` times the outputs: factors of the inputs, and the sum of all offsets, (n,)."""
        negative = np.minimum(factor, 0)
        offset: Floats = (negative * self.offset).sum(axis=(0, 1))
        return np.maximum(factor, 0) * self._steep + negative * self.above, offset


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


# BLAS maps a buffer of 32 MB at its first product of some size: here, before memory is locked, it stays unused
_ = np.ones((CHUNK, CHUNK), np.float32) @ np.ones((CHUNK, CHUNK), np.float32)
