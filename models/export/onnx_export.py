"""Exports a fitted learner as one ONNX graph from action arguments to seconds, joules or probability of success."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import onnx

from tailor.models.export.onnx_features import add_features, as_columns
from tailor.models.export.onnx_graph import Graph
from tailor.models.export.onnx_trees import add_bag, add_probability, add_tree
from tailor.models.failure.failure_model import FailureTrees
from tailor.models.features.features import FeatureSpace
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
      A model from double `arguments` (n, k) to float `mean_s` and `std_s` (or `mean_j`, `std_j`), shapes (n,).

    Raises:
      TypeError: The learner is of another type.
    """
    graph = Graph()
    features = add_features(graph, space, "arguments")
    match learner:
        case BaggedModelTrees():
            mean, std = add_bag(graph, features, learner.trees_)
        case ModelTreeRegressor():
            mean, std = add_tree(graph, features, learner.tree_)
        case SklearnRegressor():
            from tailor.models.export.onnx_sklearn import add_regressor

            columns = as_columns(graph, features)
            mean, std = add_regressor(graph, columns, learner.inner_, learner.low_, learner.high_, learner.std_)
        case _:
            raise TypeError(f"no export for {type(learner).__name__}")
    return graph.model(len(space.arguments), {f"mean_{unit}": mean, f"std_{unit}": std}, notes)


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
