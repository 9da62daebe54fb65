"""A builder of ONNX graphs that names nodes and constants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
import onnx
from numpy.typing import NDArray
from onnx import TensorProto, helper, numpy_helper

OPSET, ML_OPSET, IR_VERSION = 18, 3, 9  # supported by onnxruntime from 1.14 on
ML = "ai.onnx.ml"


class Sink(Protocol):
    """Receiver of nodes: our own graph, or skl2onnx's container."""

    def add(self, op: str, *inputs: str, outputs: int = 1, domain: str = "", **attributes: Any) -> Any:
        """Add a node; returns the name of its output, or a list of names when it has several."""
        ...

    def constant(self, value: NDArray[Any], name: str = "") -> str:
        """Name of a constant tensor; a constant that is read back is given a name."""
        ...


class Graph:
    """An ONNX graph under construction."""

    def __init__(self) -> None:
        self._nodes: list[onnx.NodeProto] = []
        self._constants: dict[tuple[str, str, tuple[int, ...], bytes], str] = {}
        self._tensors: list[TensorProto] = []

    def add(self, op: str, *inputs: str, outputs: int = 1, domain: str = "", **attributes: Any) -> Any:
        """Add a node; returns the name of its output, or a list of names when it has several."""
        names = [f"{op.lower()}_{len(self._nodes)}_{k}" for k in range(outputs)]
        self._nodes.append(helper.make_node(op, list(inputs), names, domain=domain, **attributes))
        return names[0] if outputs == 1 else names

    def constant(self, value: NDArray[Any], name: str = "") -> str:
        """Name of a constant tensor, given or new; equal constants without a name are stored once."""
        key = (name, value.dtype.str, value.shape, value.tobytes())
        if key not in self._constants:
            self._constants[key] = name or f"constant_{len(self._constants)}"
            self._tensors.append(numpy_helper.from_array(value, self._constants[key]))
        return self._constants[key]

    def embed(self, model: onnx.ModelProto, feed: str) -> list[str]:
        """Copy another model's graph, its one input connected to `feed`; returns the names of its outputs here."""
        prefix = f"inner_{len(self._nodes)}_"
        names = {model.graph.input[0].name: feed, "": ""}
        for tensor in model.graph.initializer:
            names[tensor.name] = self.constant(numpy_helper.to_array(tensor))
        for node in model.graph.node:
            copy = onnx.NodeProto()
            copy.CopyFrom(node)
            for side in (copy.input, copy.output):
                for k, name in enumerate(side):
                    side[k] = names.setdefault(name, prefix + name)
            copy.name = ""
            self._nodes.append(copy)
        return [names[output.name] for output in model.graph.output]

    def model(self, width: int, outputs: Mapping[str, str], notes: Mapping[str, str]) -> onnx.ModelProto:
        """Finished model: double `arguments` (n, width) to float vectors (n,).

        Args:
          width: Number of arguments.
          outputs: Public name of each output to its name in the graph.
          notes: Metadata of the file.
        """
        nodes = [*self._nodes, *(helper.make_node("Identity", [inner], [name]) for name, inner in outputs.items())]
        graph = helper.make_graph(
            _without_identities(nodes, outputs),
            "action model",
            [helper.make_tensor_value_info("arguments", TensorProto.DOUBLE, ["n", width])],
            [helper.make_tensor_value_info(name, TensorProto.FLOAT, ["n"]) for name in outputs],
            self._tensors,
        )
        opsets = [helper.make_opsetid("", OPSET), helper.make_opsetid(ML, ML_OPSET)]
        model = helper.make_model(graph, opset_imports=opsets, ir_version=IR_VERSION, producer_name="tailor")
        helper.set_model_props(model, dict(notes))
        onnx.checker.check_model(model)
        return model


def _without_identities(nodes: Sequence[onnx.NodeProto], outputs: Mapping[str, str]) -> list[onnx.NodeProto]:
    """Rename the graph's inner results to the public names instead of copying them."""
    public = {inner: name for name, inner in outputs.items()}
    kept = [node for node in nodes if not (node.op_type == "Identity" and node.output[0] in outputs)]
    for node in kept:
        for names in (node.input, node.output):
            for k, name in enumerate(names):
                names[k] = public.get(name, name)
    return kept


def single(value: float) -> NDArray[np.float32]:
    """A single precision scalar."""
    return np.asarray(value, np.float32)
