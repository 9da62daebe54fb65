"""Traces feature spaces into ONNX: the functions of features.py run on symbols that add nodes to a graph."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from onnx import TensorProto

from tailor.models.export.onnx_graph import Sink, single
from tailor.models.features.features import FeatureSpace


@dataclass(frozen=True, slots=True)
class Symbol:
    """Rows of the graph under construction, shape (k, n), single precision."""

    sink: Sink
    name: str

    def pair(self, op: str, other: Symbol | float, swapped: bool = False) -> Symbol:
        """A node of this symbol and another operand."""
        name = other.name if isinstance(other, Symbol) else self.sink.constant(single(other))
        pair = (name, self.name) if swapped else (self.name, name)
        return Symbol(self.sink, self.sink.add(op, *pair))

    def __getitem__(self, rows: list[int]) -> Symbol:
        return Symbol(self.sink, self.sink.add("Gather", self.name, self.sink.constant(np.array(rows)), axis=0))

    def __add__(self, other: Symbol | float) -> Symbol:
        return self.pair("Add", other)

    def __radd__(self, other: float) -> Symbol:
        return self.pair("Add", other, swapped=True)

    def __sub__(self, other: Symbol | float) -> Symbol:
        return self.pair("Sub", other)

    def __rsub__(self, other: float) -> Symbol:
        return self.pair("Sub", other, swapped=True)

    def __mul__(self, other: Symbol | float) -> Symbol:
        return self.pair("Mul", other)

    def __rmul__(self, other: float) -> Symbol:
        return self.pair("Mul", other, swapped=True)

    def __truediv__(self, other: Symbol | float) -> Symbol:
        return self.pair("Div", other)

    def __rtruediv__(self, other: float) -> Symbol:
        return self.pair("Div", other, swapped=True)

    def __lt__(self, other: Symbol | float) -> Symbol:
        return self.pair("Less", other)

    def __gt__(self, other: Symbol | float) -> Symbol:
        return self.pair("Greater", other)

    def __neg__(self) -> Symbol:
        return Symbol(self.sink, self.sink.add("Neg", self.name))


class Tracing:
    """The `Operations` of features.py on symbols."""

    def sqrt(self, a: Symbol) -> Symbol:
        """Square root."""
        return Symbol(a.sink, a.sink.add("Sqrt", a.name))

    def absolute(self, a: Symbol) -> Symbol:
        """Absolute value."""
        return Symbol(a.sink, a.sink.add("Abs", a.name))

    def round(self, a: Symbol) -> Symbol:
        """Nearest whole number, ties to even."""
        return Symbol(a.sink, a.sink.add("Round", a.name))

    def clip(self, a: Symbol, low: float, high: float) -> Symbol:
        """Values clipped to [low, high]."""
        ends = (a.sink.constant(single(end)) for end in (low, high))
        return Symbol(a.sink, a.sink.add("Clip", a.name, *ends))

    def lower(self, a: Symbol, b: Symbol | float) -> Symbol:
        """The lower element of each pair."""
        return a.pair("Min", b)

    def higher(self, a: Symbol, b: Symbol | float) -> Symbol:
        """The higher element of each pair."""
        return a.pair("Max", b)

    def least(self, a: Symbol, groups: int, size: int) -> Symbol:
        """Least row of each group of `size` neighbours: from (groups · size, n) to (groups, n)."""
        grouped = a.sink.add("Reshape", a.name, a.sink.constant(np.array([groups, size, -1])))
        return Symbol(a.sink, a.sink.add("ReduceMin", grouped, a.sink.constant(np.array([1])), keepdims=0))

    def where(self, condition: Symbol, a: Symbol | float, b: Symbol | float) -> Symbol:
        """Elements of `a` where the condition holds, of `b` elsewhere."""
        sink = condition.sink
        names = (each.name if isinstance(each, Symbol) else sink.constant(single(each)) for each in (a, b))
        return Symbol(sink, sink.add("Where", condition.name, *names))

    def stack(self, *parts: Symbol) -> Symbol:
        """All rows of the parts, in order."""
        return Symbol(parts[0].sink, parts[0].sink.add("Concat", *(part.name for part in parts), axis=0))


def add_features(sink: Sink, space: FeatureSpace, arguments: str) -> str:
    """Add a feature space to a graph: from double arguments (n, k) to a row per feature, float (f, n)."""
    values = sink.add("Cast", arguments, to=TensorProto.FLOAT)
    rows: Symbol = space.rows(Symbol(sink, as_rows(sink, values, len(space.arguments))), Tracing())
    return rows.name


def as_rows(sink: Sink, columns: str, count: int) -> str:
    """Columns (n, count) as rows (count, n): the runtime is fast on long rows.

    The product with ones and zeros is exact; a row with a number that is not finite becomes NaN as a whole.
    """
    return str(sink.add("Gemm", sink.constant(np.eye(count, dtype=np.float32)), columns, transB=1))


def as_columns(sink: Sink, rows: str) -> str:
    """Rows (f, n) as columns (n, f), which tree ensembles require."""
    return str(sink.add("Transpose", rows, perm=[1, 0]))
