"""Turns a fitted learner into one ONNX graph from raw action arguments to seconds, or to the probability of success."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import onnx

from models.failure_tree import FailureModel
from models.features import FeatureSpace
from models.model_tree import BaggedModelTrees, ModelTreeRegressor
from models.onnx_features import add_features
from models.onnx_graph import Graph
from models.onnx_trees import add_bag, add_steps, add_tree


def export_duration(
    learner: ModelTreeRegressor | BaggedModelTrees, space: FeatureSpace, notes: Mapping[str, str]
) -> onnx.ModelProto:
    """Double `arguments` (n, k) to float `mean_s` and `std_s`, (n,); `notes` become the file's metadata."""
    graph = Graph()
    features = add_features(graph, space, "arguments")
    if isinstance(learner, BaggedModelTrees):
        mean, spread = add_bag(graph, features, learner.trees_)
    else:
        mean, spread = add_tree(graph, features, learner.tree_)
    return graph.model(len(space.arguments), {"mean_s": mean, "std_s": spread}, notes)


def export_success(learner: FailureModel, space: FeatureSpace, notes: Mapping[str, str]) -> onnx.ModelProto:
    """Double `arguments` (n, k) to float `success` (n,); `notes` become the file's metadata."""
    graph = Graph()
    features = add_features(graph, space, "arguments")
    count = len(learner.steps_)
    column = add_steps(graph, features, [(tree, values / np.float32(count)) for tree, values in learner.steps_])
    success = graph.add("Reshape", column, graph.constant(np.array([-1])))
    return graph.model(len(space.arguments), {"success": success}, notes)
