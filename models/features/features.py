"""Feature spaces of action models: pure functions of action arguments, defined once for all uses.

Training calls them on arrays, export on symbols of an ONNX graph. They use only operations that IEEE 754 rounds
exactly, in single precision and in a fixed order, so numpy and onnxruntime give the same bits, on thresholds too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
Rows = Any  # an array of shape (k, n), or a symbol of the exported graph; both support + - * / < and row indices

TWO_PI = 2 * np.pi
SAME_PLACE = 1e-6  # m (or rad): below this distance there is no line of sight
STEEP = 1e38  # a ramp of this slope is a step
# atan2(dy, dx) = dy·Σ w / (dist + g·dx) for dx >= 0, like Gauss quadrature; (w, g) are fitted: the error is at
# most 1e-5 rad, far below any pose noise, and 0 straight ahead and sideways
ARCTANGENT = ((1.06079778, 0.84703681), (0.50999855, 0.19823857))


class Operations(Protocol):
    """Operations of features besides arithmetic, implemented by numpy and by the ONNX exporter."""

    def sqrt(self, a: Rows) -> Rows:
        """Square root."""

    def absolute(self, a: Rows) -> Rows:
        """Absolute value."""

    def round(self, a: Rows) -> Rows:
        """Nearest whole number, ties to even."""

    def clip(self, a: Rows, low: float, high: float) -> Rows:
        """Values clipped to [low, high]."""

    def lower(self, a: Rows, b: Rows) -> Rows:
        """The lower element of each pair."""

    def higher(self, a: Rows, b: Rows) -> Rows:
        """The higher element of each pair."""

    def least(self, a: Rows, groups: int, size: int) -> Rows:
        """Least row of each group of `size` neighbours: from (groups · size, n) to (groups, n)."""

    def where(self, condition: Rows, a: Rows, b: Rows) -> Rows:
        """Elements of `a` where the condition holds, of `b` elsewhere."""

    def stack(self, *parts: Rows) -> Rows:
        """All rows of the parts, in order."""


class _Numpy:
    sqrt = staticmethod(np.sqrt)
    absolute = staticmethod(np.absolute)
    round = staticmethod(np.round)
    clip = staticmethod(np.clip)
    lower = staticmethod(np.minimum)
    higher = staticmethod(np.maximum)
    where = staticmethod(np.where)

    @staticmethod
    def least(a: Rows, groups: int, size: int) -> Rows:
        return a.reshape(groups, size, -1).min(axis=1)

    @staticmethod
    def stack(*parts: Rows) -> Rows:
        return np.vstack(parts)


NUMPY: Operations = _Numpy()


@dataclass(frozen=True, slots=True)
class Quantity:
    """A named number with its unit: a column of arguments or of features."""

    name: str
    unit: str


@dataclass(frozen=True, slots=True)
class FeatureSpace:
    """A map from an action's arguments to the features of a model.

    Attributes:
      name: Name in cards; unique among all packages of robots.
      arguments: Names and units of the arguments, k.
      features: Names and units of the features, f.
      rows: Computes features (f, n) from arguments (k, n). It is traced for export, so it may only use arithmetic, row
        indices and `Operations`.
    """

    name: str
    arguments: tuple[Quantity, ...]
    features: tuple[Quantity, ...]
    rows: Callable[[Rows, Operations], Rows]

    def __call__(self, arguments: Array) -> NDArray[np.float32]:
        """Compute features.

        Args:
          arguments: Shape (n, k), in the units of `self.arguments`.

        Returns:
          Features in single precision, shape (n, f), in the units of `self.features`; NaN for arguments that are NaN.

        Raises:
          ValueError: The arguments have another number of columns.
        """
        if arguments.ndim != 2 or arguments.shape[1] != len(self.arguments):
            raise ValueError(f"{self.name} takes (n, {len(self.arguments)}) arguments, got {arguments.shape}")
        # a NaN argument gives NaN features, which the models mark as invalid; at zero distance there is no direction
        with np.errstate(invalid="ignore", divide="ignore"):
            rows = self.rows(np.ascontiguousarray(arguments.T, np.float32), NUMPY)
        return np.ascontiguousarray(rows.T)


def wrap(a: Rows, ops: Operations) -> Rows:
    """The paper's norm(a): angles in radians wrapped to [-pi, pi]."""
    return a - ops.round(a * (1 / TWO_PI)) * TWO_PI


def length(dx: Rows, dy: Rows, ops: Operations) -> Rows:
    """Euclidean length of (dx, dy)."""
    return ops.sqrt(dx * dx + dy * dy)


def direction(dx: Rows, dy: Rows, dist: Rows, otherwise: Rows, ops: Operations) -> Rows:
    """atan2(dy, dx) up to whole turns; `otherwise` where the length `dist` is (almost) zero."""
    across = ops.absolute(dx)
    (w, g), (v, h) = ARCTANGENT
    ahead = (w / (dist + across * g) + v / (dist + across * h)) * dy
    return ops.where(dist < SAME_PLACE, otherwise, ops.where(dx < 0.0, np.pi - ahead, ahead))


def quantities(text: str) -> tuple[Quantity, ...]:
    """Quantities written as `name:unit`, separated by blanks."""
    return tuple(Quantity(*item.split(":")) for item in text.split())
