"""Lower bounds of a mean of networks over boxes of features, by linear relaxation (CROWN, Zhang et al. 2018).

Each rectifier lies between two lines over the range of its input. Propagated back, they give a linear lower bound of
the mean of all networks, which is minimised over the box: far tighter than the sum of each neuron's minimum.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import count, takewhile

import numpy as np
from numpy.typing import NDArray

from tailor.models.bounds.feature_boxes import FeatureBoxes, boxes_between
from tailor.models.bounds.leaf_bounds import FARTHEST, ROUNDING
from tailor.models.bounds.onnx_reader import Contents
from tailor.models.bounds.rectified import Rectified
from tailor.models.features.intervals import Span
from tailor.models.fitted_trees import tree_names

Floats = NDArray[np.float32]
OPERATIONS = 5  # for each neuron of a network, about: they take as long as so many comparisons of leaves
WIDE = 0.02  # m, rad, m/s: in wider boxes knowing the deviation costs more time than it gains
CHUNK = 64  # boxes: their arrays fit into the cache


@dataclass(frozen=True)
class NetworkBounds:
    """The bounds of the mean of k networks with rectified hidden layers, clipped to [low, high]."""

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
        return np.float32((len(self.weights) + 1) * ROUNDING) * size[:, 0]

    def _outputs(self, boxes: FeatureBoxes) -> tuple[Floats, Floats]:
        """Middle and reach of each network's output with its rounding error, (k, n) each."""
        middle, reach = _spread(self._layers(boxes)[-1], self.weights[-1], self.bias[-1])
        return middle[:, 0], reach[:, 0] + self._rounding(np.abs(boxes.middle) + boxes.radius)

    def _plane(self, boxes: FeatureBoxes, sign: np.float32) -> tuple[Floats, Floats]:
        networks, features = len(self.bias[-1]), len(boxes.middle)
        factor = np.full((networks, 1, 1), sign / np.float32(networks))
        constant = np.full(boxes.middle.shape[1], sign * self.bias[-1].mean())
        hidden = zip(self._layers(boxes)[::-1], self.bias[-2::-1], self.weights[:0:-1], strict=True)
        for layer, bias, after in hidden:
            factor, offset = layer.below(after.transpose(0, 2, 1) @ factor)
            constant += offset + _total(factor, bias)
        slopes: Floats = self.weights[0].reshape(-1, features).T @ factor.reshape(-1, len(constant))  # of all networks
        return constant, slopes

    def _layers(self, boxes: FeatureBoxes) -> list[Rectified]:
        """All layers of rectifiers over the boxes.

        Each but the first has the intersection of two ranges. In one, each output before it lies between its ends; in
        the other, its inputs lie in strips: `width` around functions that are linear in the features.
        """
        middle = self.weights[0] @ boxes.middle + self.bias[0]
        layer = Rectified(*boxes.ends(middle, self.weights[0]))
        width = np.zeros_like(middle)
        slopes = [self.weights[0][:, :, feature, None] for feature in range(self.weights[0].shape[2])]
        layers = [layer]
        for weights, bias in zip(self.weights[1:-1], self.bias[1:-1], strict=True):
            half = np.float32(0.5) * layer.offset
            middle = weights @ (layer.above * middle + half) + bias
            width = np.abs(weights) @ (layer.above * width + half)
            slopes = [weights @ (layer.above * slope) for slope in slopes]
            strip = boxes.ends_of_slopes(middle, width, slopes)
            centre, reach = _spread(layer, weights, bias)
            layer = Rectified(np.maximum(centre - reach, strip[0]), np.minimum(centre + reach, strip[1]))
            layers.append(layer)
        return layers


def _spread(layer: Rectified, weights: Floats, bias: Floats) -> tuple[Floats, Floats]:
    """Middle and reach of the next layer's inputs, (k, out, n), if each output lies anywhere between its ends."""
    low: Floats = np.maximum(layer.lower, 0)
    centre: Floats = np.float32(0.5) * (low + layer.high)
    return weights @ centre + bias, np.abs(weights) @ (layer.high - centre)


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
    weights, bias = (_of_layers(graph, name) for name in (tree_names.NETWORK_WEIGHTS, tree_names.NETWORK_BIAS))
    low, high = (float(graph.constants[name].ravel()[0]) for name in (tree_names.NETWORK_LOW, tree_names.NETWORK_HIGH))
    names = list(graph.constants)  # in the order of the members
    of_trees = int(tree_names.LOW not in names[: names.index(tree_names.NETWORK_LOW)])
    share = graph.constants.get(tree_names.MEMBER_WEIGHT.format(of_trees))
    return NetworkBounds(weights, bias, low, high, 0.0 if share is None else float(share.ravel()[0]))


def _of_layers(graph: Contents, name: str) -> tuple[Floats, ...]:
    found = (graph.constants.get(name.format(layer)) for layer in count())
    return tuple(np.asarray(each, np.float32) for each in takewhile(lambda each: each is not None, found))


# BLAS maps a buffer of 32 MB at its first product of some size: here, before memory is locked, it stays unused
_ = np.ones((CHUNK, CHUNK), np.float32) @ np.ones((CHUNK, CHUNK), np.float32)
