"""The tree of prediction intervals of an ONNX action model as boxes of features: the input of bounds on the spread."""

from __future__ import annotations

import numpy as np

from tailor.models.bounds.onnx_reader import Contents
from tailor.models.bounds.tree_boxes import TreeBoxes, boxes_of_node
from tailor.models.fitted_trees import tree_names

UPPER_SCORE = 1.6448536  # standard deviations between mean and 95 % quantile of a normal distribution


def interval_boxes(graph: Contents, features: int) -> TreeBoxes | None:
    """The spread, (upper end - mean) / UPPER_SCORE, by leaf; None if the model has no intervals.

    The last of the `features + 1` columns is the learner's standard deviation.

    Raises:
      ValueError: The tree is not of the form that the export writes.
      KeyError: A constant is missing.
    """
    nodes = [node for node in graph.nodes if node.name == tree_names.INTERVALS]
    if not nodes:
        return None
    lower, upper, numbers = boxes_of_node(nodes[0], features + 1)
    upper_end = graph.constants[tree_names.INTERVAL_UPPER].astype(np.float32)[numbers.astype(np.int64)]
    spread = upper_end / np.float32(UPPER_SCORE)
    return TreeBoxes(np.array([0]), lower, upper, np.zeros_like(lower), spread, spread, spread)
