"""Registers our estimators with skl2onnx: `to_onnx(model, X)` converts them, also inside pipelines."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from onnx import TensorProto
from skl2onnx import update_registered_converter
from skl2onnx.common.data_types import FloatTensorType, Int64TensorType, guess_tensor_type

from tailor.models.export.onnx_features import as_rows
from tailor.models.export.onnx_graph import ML, ML_OPSET, OPSET
from tailor.models.export.onnx_trees import add_bag, add_probability, add_tree
from tailor.models.failure.constant_success import ConstantSuccess
from tailor.models.failure.distilled_forest import DistilledForest
from tailor.models.failure.distilled_tree import DistilledFailureTree
from tailor.models.failure.failure_forest import FailureForest
from tailor.models.failure.failure_tree import FailureTree
from tailor.models.trees.distillation import DistilledModelTree
from tailor.models.trees.model_tree import BaggedModelTrees, ModelTreeRegressor

TYPES = {"f4": TensorProto.FLOAT, "u2": TensorProto.UINT16, "i4": TensorProto.INT32, "i8": TensorProto.INT64}


class _ContainerSink:
    """Adds nodes to skl2onnx's container."""

    def __init__(self, scope: Any, container: Any) -> None:
        self._scope, self._container = scope, container

    def add(self, op: str, *inputs: str, outputs: int = 1, domain: str = "", **attributes: Any) -> Any:
        """Add a node; returns the name of its output, or a list of names when it has several."""
        names = [self._scope.get_unique_variable_name(op.lower()) for _ in range(outputs)]
        name = self._scope.get_unique_operator_name(op)
        version = ML_OPSET if domain == ML else OPSET
        self._container.add_node(op, list(inputs), names, domain, version, name=name, **attributes)
        return names[0] if outputs == 1 else names

    def constant(self, value: NDArray[Any], name: str = "constant") -> str:
        """Name of a constant tensor, with a number if the name is taken."""
        name = str(self._scope.get_unique_variable_name(name))
        kind = TYPES[value.dtype.str[1:]]
        self._container.add_initializer(name, kind, list(value.shape), value.ravel().tolist())
        return name


def register() -> None:
    """Register all converters; may be called repeatedly."""
    for regressor in (ModelTreeRegressor, DistilledModelTree, BaggedModelTrees):
        update_registered_converter(regressor, f"Tailor{regressor.__name__}", _regressor_shape, _convert_regressor)
    for classifier in (ConstantSuccess, FailureTree, FailureForest, DistilledForest, DistilledFailureTree):
        update_registered_converter(
            classifier,
            f"Tailor{classifier.__name__}",
            _classifier_shape,
            _convert_classifier,
            options={"zipmap": [False], "nocl": [True, False], "output_class_labels": [False, True]},
        )


def _regressor_shape(operator: Any) -> None:
    rows = operator.inputs[0].get_first_dimension()
    operator.outputs[0].type = FloatTensorType([rows, 1])


def _classifier_shape(operator: Any) -> None:
    rows = operator.inputs[0].get_first_dimension()
    operator.outputs[0].type = Int64TensorType([rows])
    operator.outputs[1].type = FloatTensorType([rows, 2])


def _features(sink: _ContainerSink, operator: Any) -> str:
    guess_tensor_type(operator.inputs[0].type)  # raises if the inputs are not numbers
    return str(sink.add("Cast", operator.inputs[0].full_name, to=TensorProto.FLOAT))


def _convert_regressor(scope: Any, operator: Any, container: Any) -> None:
    sink, learner = _ContainerSink(scope, container), operator.raw_operator
    features = as_rows(sink, _features(sink, operator), learner.n_features_in_)
    if isinstance(learner, BaggedModelTrees):
        mean, _ = add_bag(sink, features, learner.trees_)
    else:
        mean, _ = add_tree(sink, features, learner.tree_)
    column = sink.add("Reshape", mean, sink.constant(np.array([-1, 1])))
    container.add_node("Identity", column, operator.outputs[0].full_name)


def _convert_classifier(scope: Any, operator: Any, container: Any) -> None:
    sink, learner = _ContainerSink(scope, container), operator.raw_operator
    success = add_probability(sink, _features(sink, operator), learner.steps_)
    column = sink.add("Reshape", success, sink.constant(np.array([-1, 1])))
    failure = sink.add("Sub", sink.constant(np.array([[1.0]], np.float32)), column)
    above = sink.add("GreaterOrEqual", success, sink.constant(np.array([learner.threshold_], np.float32)))
    container.add_node("Cast", above, operator.outputs[0].full_name, to=TensorProto.INT64)
    both = sink.add("Concat", failure, column, axis=1)
    container.add_node("Identity", both, operator.outputs[1].full_name)
