"""Exports a fitted learner as one ONNX graph from action arguments to seconds, joules or probability of success."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import onnx

from tailor.models.export.onnx_features import add_features, as_columns
from tailor.models.export.onnx_graph import Graph
from tailor.models.export.onnx_networks import add_intervals, add_mixture, add_networks
from tailor.models.export.onnx_trees import add_bag, add_probability, add_tree
from tailor.models.failure.failure_model import FailureTrees
from tailor.models.features.features import FeatureSpace
from tailor.models.regression.blend import BlendedRegressor
from tailor.models.regression.calibrated import CalibratedRegressor
from tailor.models.regression.network import NetworkRegressor
from tailor.models.training.sklearn_adapters import SklearnClassifier, SklearnRegressor
from tailor.models.trees.model_tree import BaggedModelTrees, ModelTreeRegressor


def export_duration(learner: Any, space: FeatureSpace, notes: Mapping[str, str], unit: str = "s") -> onnx.ModelProto:
    """Export a model of durations or energies.

    Args:
      learner: A fitted `RegressionModel`.
      space: Its feature space.
      notes: Metadata of the file.
      unit: Suffix of the outputs: "s", or "j" for energies.

    Returns:
      A model from double `arguments` (n, k) to float `mean_s` and `std_s` (or `mean_j`, `std_j`), shapes (n,). Of a
      calibrated learner to `mean_s`, `lower_s` and `upper_s`, the ends of the prediction interval.

    Raises:
      TypeError: The learner is of another type.
    """
    graph = Graph()
    features = add_features(graph, space, "arguments")
    if isinstance(learner, CalibratedRegressor):
        mean, std = _mean_and_std(graph, features, learner.inner_)
        lower, upper = add_intervals(graph, features, mean, std, learner.intervals_)
        outputs = {f"mean_{unit}": mean, f"lower_{unit}": lower, f"upper_{unit}": upper}
    else:
        mean, std = _mean_and_std(graph, features, learner)
        outputs = {f"mean_{unit}": mean, f"std_{unit}": std}
    return graph.model(len(space.arguments), outputs, notes)


def _mean_and_std(graph: Graph, features: str, learner: Any) -> tuple[str, str]:
    """Mean and standard deviation, shapes (n,), of rows of features (f, n)."""
    match learner:
        case BaggedModelTrees():
            return add_bag(graph, features, learner.trees_)
        case ModelTreeRegressor():
            return add_tree(graph, features, learner.tree_)
        case NetworkRegressor():
            return add_networks(graph, features, learner)
        case BlendedRegressor():
            parts = [_mean_and_std(graph, features, member) for member in learner.members_.values()]
            return add_mixture(graph, parts, list(learner.weights_.values()))
        case SklearnRegressor():
            from tailor.models.export.onnx_sklearn import add_regressor

            columns = as_columns(graph, features)
            return add_regressor(graph, columns, learner.inner_, learner.low_, learner.high_, learner.std_)
    raise TypeError(f"no export for {type(learner).__name__}")


def export_success(learner: Any, space: FeatureSpace, notes: Mapping[str, str]) -> onnx.ModelProto:
    """Export a model of success.

    Args:
      learner: A fitted `FailureModel`.
      space: Its feature space.
      notes: Metadata of the file.

    Returns:
      A model from double `arguments` (n, k) to float `success`, 0..1, shape (n,).

    Raises:
      TypeError: The learner is of another type.
    """
    graph = Graph()
    features = as_columns(graph, add_features(graph, space, "arguments"))
    match learner:
        case FailureTrees():
            success = add_probability(graph, features, learner.steps_)
        case SklearnClassifier():
            from tailor.models.export.onnx_sklearn import add_classifier

            success = add_classifier(graph, features, learner.inner_)
        case _:
            raise TypeError(f"no export for {type(learner).__name__}")
    return graph.model(len(space.arguments), {"success": success}, notes)
