"""Adds scikit-learn's estimators to our graphs, through skl2onnx."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import onnx
from onnx import TensorProto
from skl2onnx import to_onnx

from tailor.models.export.onnx_graph import ML, ML_OPSET, OPSET, Graph, single

TARGETS = {"": OPSET, ML: ML_OPSET}


def add_regressor(graph: Graph, features: str, inner: Any, low: float, high: float, std: float) -> tuple[str, str]:
    """Mean, clipped to [low, high], and a constant standard deviation, shapes (n,), of features (n, f)."""
    (value,) = graph.embed(_converted(inner, {}), features)
    flat = graph.add("Reshape", value, graph.constant(np.array([-1])))
    mean = graph.add("Min", graph.add("Max", flat, graph.constant(single(low))), graph.constant(single(high)))
    zero = graph.add("Mul", mean, graph.constant(single(0.0)))
    return str(mean), str(graph.add("Add", zero, graph.constant(single(std))))


def add_classifier(graph: Graph, features: str, inner: Any) -> str:
    """Probability of the second class, success, shape (n,), of features (n, f)."""
    _, both = graph.embed(_converted(inner, {"zipmap": False}), features)
    column = graph.add("Gather", both, graph.constant(np.array(1)), axis=1)
    return str(graph.add("Cast", column, to=TensorProto.FLOAT))


def _converted(inner: Any, options: dict[str, Any]) -> onnx.ModelProto:
    width = inner.n_features_in_
    chosen = {id(inner): options} if options else None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)  # skl2onnx reads attributes that scikit-learn deprecates
        model: onnx.ModelProto = to_onnx(inner, np.zeros((1, width), np.float32), options=chosen, target_opset=TARGETS)
    return model
