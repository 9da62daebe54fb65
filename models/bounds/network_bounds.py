"""Lower bounds of a mean of networks over boxes of features, by linear relaxation (CROWN, Zhang et al. 2018).

Each rectifier lies between two lines over the range of its input. Propagated back, they give a linear lower bound of
the mean of all networks, which is minimised over the box: far tighter than the sum of each neuron's minimum.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.feature_boxes import FeatureBoxes, boxes_between
from tailor.models.bounds.leaf_bounds import FARTHEST, ROUNDING
from tailor.models.bounds.onnx_reader import Contents
from tailor.models.bounds.rectified import Rectified
from tailor.models.features.intervals import Span
from tailor.models.fitted_trees import tree_names

Floats = NDArray[np.float32]
LAYERS = 3
OPERATIONS = 5  # for each neuron of a network, about: they take as long as so many comparisons of leaves
WIDE = 0.02  # m, rad, m/s: in wider boxes knowing the deviation costs more time than it gains
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
        boxes, shape = _boxes(features)
        constant, slopes = self.plane(boxes, sign)
        bound = constant + (slopes * boxes.middle).sum(axis=0) - (np.abs(slopes) * boxes.radius).sum(axis=0)
        low, high = sorted((sign * self.low, sign * self.high))
        clipped: Floats = np.clip(bound, np.float32(low), np.float32(high))
        return clipped.reshape(shape)

    def deviation(self, features: tuple[Span, ...]) -> Span:
        """Bounds of the standard deviation over the networks, of the shape that the spans broadcast to.

        It differs from that of the networks' middles by the root mean square of their reaches at most. Where a feature
        varies by more than WIDE it is bounded by 0 and infinity.
        """
        boxes, shape = _boxes(features)
        narrow = np.flatnonzero(boxes.radius.max(axis=0) < WIDE / 2)
        lower, upper = np.zeros(boxes.radius.shape[1]), np.full(boxes.radius.shape[1], np.inf)
        for first in range(0, len(narrow), CHUNK):
            some = narrow[first : first + CHUNK]
            middle, reach = self._outputs(boxes.part(some))
            std, off = middle.std(axis=0), np.sqrt(np.square(reach).mean(axis=0))
            lower[some], upper[some] = np.maximum(std - off, 0.0), std + off
        return Span(lower.reshape(shape), upper.reshape(shape))

    def plane(self, boxes: FeatureBoxes, sign: int = 1) -> tuple[Floats, Floats]:
        """Linear lower bound of `sign` times the mean without clipping: constants, (n,), and slopes, (f, n)."""
        count = boxes.middle.shape[1]
        parts = (boxes.part(slice(first, first + CHUNK)) for first in range(0, count, CHUNK))
        constants, slopes = zip(*(self._plane(part, np.float32(sign)) for part in parts), strict=True)
        return np.concatenate(constants) - np.float32(self.slack), np.concatenate(slopes, axis=1)

    @cached_property
    def slack(self) -> float:
        """Bound of the rounding error of the mean in single precision, here and in the model."""
        return float(self._rounding(np.full((self.weights[0].shape[2], 1), FARTHEST, np.float32)).mean())

    def _rounding(self, farthest: Floats) -> Floats:
        """Bounds of the rounding errors of all networks, (k, n), for features of these magnitudes, (f, n)."""
        size = farthest
        for weights, bias in zip(self.weights, self.bias, strict=True):
            size = np.abs(weights) @ size + np.abs(bias)
        return np.float32(4 * ROUNDING) * size[:, 0]

    def _outputs(self, boxes: FeatureBoxes) -> tuple[Floats, Floats]:
        """Middle and reach of each network's output with its rounding error, (k, n) each."""
        _, second = self._layers(boxes)
        low = np.maximum(second.lower, 0)
        centre = np.float32(0.5) * (low + second.high)
        weights, bias = self.weights[2], self.bias[2]
        reach = (np.abs(weights) @ (second.high - centre))[:, 0]
        return (weights @ centre + bias)[:, 0], reach + self._rounding(np.abs(boxes.middle) + boxes.radius)

    def _layers(self, boxes: FeatureBoxes) -> tuple[Rectified, Rectified]:
        """Both layers of rectifiers over the boxes."""
        inputs = self.weights[0] @ boxes.middle + self.bias[0]
        first = Rectified(*boxes.ends(inputs, self.weights[0]))
        return first, Rectified(*self._second_inputs(first, inputs, boxes))

    def _plane(self, boxes: FeatureBoxes, sign: np.float32) -> tuple[Floats, Floats]:
        (w1, w2, w3), (b1, b2, b3) = self.weights, self.bias
        first, second = self._layers(boxes)
        factor, constant = second.below(sign / np.float32(len(w3)) * w3.transpose(0, 2, 1))
        constant = sign * b3.mean() + constant + _total(factor, b2)
        factor, offset = first.below(w2.transpose(0, 2, 1) @ factor)
        constant += offset + _total(factor, b1)
        slopes: Floats = w1.reshape(-1, len(boxes.middle)).T @ factor.reshape(-1, len(constant))  # of all networks
        return constant, slopes

    def _second_inputs(self, first: Rectified, inputs: Floats, boxes: FeatureBoxes) -> tuple[Floats, Floats]:
        """Both ends of the second layer's inputs: two relaxations of the first layer, intersected.

        Each output apart lies between the ends of its range; as a function of the features it lies in a strip.
        """
        w1, w2, b2 = self.weights[0], self.weights[1], self.bias[1]
        half, size = np.float32(0.5), np.abs(w2)
        low: Floats = np.maximum(first.lower, 0)
        centre: Floats = half * (low + first.high)
        middle, reach = w2 @ centre + b2, size @ (first.high - centre)
        width: Floats = half * first.offset
        slopes = [w2 @ (w1[:, :, feature, None] * first.above) for feature in range(w1.shape[2])]
        strip = boxes.ends_of_slopes(w2 @ (first.above * inputs + width) + b2, size @ width, slopes)
        return np.maximum(middle - reach, strip[0]), np.minimum(middle + reach, strip[1])


def _boxes(features: tuple[Span, ...]) -> tuple[FeatureBoxes, tuple[int, ...]]:
    """Spans as boxes, one after another, and the shape that they broadcast to."""
    shape = np.broadcast_shapes(*(np.shape(span.lower) for span in features))
    lower, upper = (
        np.stack([np.broadcast_to(end, shape).ravel() for end in ends]).astype(np.float32)
        for ends in zip(*((span.lower, span.upper) for span in features), strict=True)
    )
    return boxes_between(lower, upper), shape


def _total(factor: Floats, bias: Floats) -> Floats:
    """Sum over networks and neurons of (k, h, n) times (k, h, 1), shape (n,)."""
    total: Floats = bias.ravel() @ factor.reshape(bias.size, -1)
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


# BLAS maps a buffer of 32 MB at its first product of some size: here, before memory is locked, it stays unused
_ = np.ones((CHUNK, CHUNK), np.float32) @ np.ones((CHUNK, CHUNK), np.float32)
