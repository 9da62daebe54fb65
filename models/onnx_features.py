"""Traces feature spaces into ONNX: the functions of features.py run on symbols that write nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from onnx import TensorProto

from models.features import FeatureSpace
from models.onnx_graph import Sink, single


@dataclass(frozen=True, slots=True)
class Symbol:
    """A column of the graph under construction, shape (1, n), single precision."""

    sink: Sink
    name: str

    def _with(self, op: str, other: Symbol | float, swapped: bool = False) -> Symbol:
        name = other.name if isinstance(other, Symbol) else self.sink.constant(single(other))
        pair = (name, self.name) if swapped else (self.name, name)
        return Symbol(self.sink, self.sink.add(op, *pair))

    def __add__(self, other: Symbol | float) -> Symbol:
        return self._with("Add", other)

    def __sub__(self, other: Symbol | float) -> Symbol:
        return self._with("Sub", other)

    def __rsub__(self, other: float) -> Symbol:
        return self._with("Sub", other, swapped=True)

    def __mul__(self, other: Symbol | float) -> Symbol:
        return self._with("Mul", other)

    def __truediv__(self, other: Symbol) -> Symbol:
        return self._with("Div", other)

    def __lt__(self, other: Symbol | float) -> Symbol:
        return self._with("Less", other)


class Tracing:
    """The `Operations` of features.py on symbols."""

    def sqrt(self, a: Symbol) -> Symbol:
        """Square root."""
        return Symbol(a.sink, a.sink.add("Sqrt", a.name))

    def absolute(self, a: Symbol) -> Symbol:
        """Magnitude."""
        return Symbol(a.sink, a.sink.add("Abs", a.name))

    def round(self, a: Symbol) -> Symbol:
        """Nearest whole number, ties to even."""
        return Symbol(a.sink, a.sink.add("Round", a.name))

    def maximum(self, a: Symbol, floor: float) -> Symbol:
        """The larger of each element and a number."""
        return a._with("Max", floor)

    def where(self, condition: Symbol, a: Symbol | float, b: Symbol) -> Symbol:
        """Elements of `a` where the condition holds, of `b` elsewhere."""
        first = a.name if isinstance(a, Symbol) else b.sink.constant(single(a))
        return Symbol(b.sink, b.sink.add("Where", condition.name, first, b.name))


def add_features(sink: Sink, space: FeatureSpace, arguments: str) -> str:
    """Write a feature space into a graph: double arguments (n, k) to float features with a one, (n, f + 1)."""
    values = sink.add("Cast", arguments, to=TensorProto.FLOAT)
    every = sink.constant(np.eye(len(space.arguments), dtype=np.float32))
    # to (1, n) each: the runtime is slow on (n, 1), and would push a Transpose through every node
    rows = sink.add("Gemm", every, values, transB=1)
    names = sink.add("Split", rows, outputs=len(space.arguments), axis=0, num_outputs=len(space.arguments))
    columns = space.columns(tuple(Symbol(sink, name) for name in names), Tracing())
    stacked = sink.add("Concat", *(column.name for column in columns), axis=0)
    return append_one(sink, stacked, len(columns), transpose=True)


def append_one(sink: Sink, features: str, count: int, transpose: bool = False) -> str:
    """Features (n, f), or (f, n) to be transposed, with a column of ones for the intercept: (n, f + 1).

    A product with ones and zeros is exact, and the runtime's optimiser does not push it up through every node.
    """
    copy = sink.constant(np.eye(count, count + 1, dtype=np.float32))
    one = sink.constant(np.eye(count + 1, dtype=np.float32)[-1])
    return str(sink.add("Gemm", features, copy, one, transA=int(transpose)))


def without_one(sink: Sink, features: str, count: int) -> str:
    """Features with a one, (n, f + 1), without it: (n, f)."""
    return str(sink.add("Gemm", features, sink.constant(np.eye(count + 1, count, dtype=np.float32))))
