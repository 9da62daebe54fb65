"""Adds networks, weighted means of learners and prediction intervals to ONNX graphs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tailor.models.export.onnx_features import as_columns
from tailor.models.export.onnx_graph import Sink, single
from tailor.models.export.onnx_leaves import add_number
from tailor.models.fitted_trees import tree_names
from tailor.models.regression.intervals import Intervals
from tailor.models.regression.network import NetworkRegressor

MeanStd = tuple[str, str]


def add_networks(sink: Sink, features: str, learner: NetworkRegressor) -> MeanStd:
    """Mean and standard deviation over networks, shapes (n,), of rows of features (f, n)."""
    values = features
    for number, layer in enumerate(learner.layers_):
        product = sink.add("MatMul", sink.constant(layer.weights, tree_names.NETWORK_WEIGHTS.format(number)), values)
        values = sink.add("Add", product, sink.constant(layer.bias, tree_names.NETWORK_BIAS.format(number)))
        if number < len(learner.layers_) - 1:
            values = sink.add("Relu", values)
    each = sink.add("Reshape", values, sink.constant(np.array([learner.networks, -1])))  # (k, n)
    share = sink.constant(np.full(learner.networks, 1 / learner.networks, np.float32))
    mean = sink.add("MatMul", share, each)
    off = sink.add("Sub", each, mean)
    std = sink.add("Sqrt", sink.add("MatMul", share, sink.add("Mul", off, off)))
    ends = {tree_names.NETWORK_LOW: learner.low_, tree_names.NETWORK_HIGH: learner.high_}
    limits = [sink.constant(single(float(end)), name) for name, end in ends.items()]
    return str(sink.add("Clip", mean, *limits)), str(std)


def add_mixture(sink: Sink, parts: Sequence[MeanStd], weights: Sequence[float]) -> MeanStd:
    """Mean and standard deviation of a mixture, as `blend.mixture`, shapes (n,)."""
    if len(parts) == 1:
        return parts[0]
    mean = _weighted(sink, [mean for mean, _ in parts], weights)
    squares = []
    for each, std in parts:
        off = sink.add("Sub", each, mean)
        squares.append(sink.add("Add", sink.add("Mul", std, std), sink.add("Mul", off, off)))
    return mean, str(sink.add("Sqrt", _weighted(sink, squares, weights)))


def add_intervals(sink: Sink, features: str, mean: str, std: str, intervals: Intervals) -> tuple[str, str]:
    """Ends of the intervals, shapes (n,), of rows of features (f, n), means and standard deviations (n,)."""
    row = sink.add("Reshape", std, sink.constant(np.array([1, -1])))
    columns = as_columns(sink, sink.add("Concat", features, row, axis=0))
    leaf = add_number(sink, columns, intervals.splits, tree_names.INTERVALS)
    tables = {tree_names.INTERVAL_LOWER: intervals.lower, tree_names.INTERVAL_UPPER: intervals.upper}
    lower, upper = (
        str(sink.add("Add", mean, sink.add("GatherElements", sink.constant(table, name), leaf, axis=0)))
        for name, table in tables.items()
    )
    return lower, upper


def _weighted(sink: Sink, values: Sequence[str], weights: Sequence[float]) -> str:
    constants = (sink.constant(single(w), tree_names.MEMBER_WEIGHT.format(k)) for k, w in enumerate(weights))
    parts = [sink.add("Mul", value, constant) for value, constant in zip(values, constants, strict=True)]
    total = parts[0]
    for part in parts[1:]:
        total = sink.add("Add", total, part)
    return str(total)
