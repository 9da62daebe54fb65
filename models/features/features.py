"""Feature spaces of the action models (Table 7): pure functions of action arguments, defined once for all uses.

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

    def where(self, condition: Rows, a: Rows, b: Rows) -> Rows:
        """Elements of `a` where the condition holds, of `b` elsewhere."""

    def stack(self, *parts: Rows) -> Rows:
        """All rows of the parts, in order."""


class _Numpy:
    sqrt = staticmethod(np.sqrt)
    absolute = staticmethod(np.absolute)
    round = staticmethod(np.round)
    clip = staticmethod(np.clip)
    where = staticmethod(np.where)

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
      name: Name in cards and in `SPACES`.
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


def _toward(rows: Rows, ops: Operations) -> tuple[Rows, Rows, Rows]:
    """Distance, |angle to the goal| and signed angle at the goal (Table 7).

    The angle at the goal is positive when the robot must turn the same way twice (an S-curve is negative). At zero
    distance the line of sight is the robot's heading, which leaves a turn on the spot. Straight ahead (angle_to = 0)
    counts as a left turn.
    """
    away = rows[[4, 5]] - rows[[0, 1]]
    dx, dy = away[[0]], away[[1]]
    dist = length(dx, dy, ops)
    turns = wrap(rows[[2, 6]] - direction(dx, dy, dist, rows[[2]], ops), ops)  # the first is minus that to the goal
    left = ops.clip(turns[[0]] * -STEEP + 1.0, -1.0, 1.0)  # or -1 where it turns right
    return dist, ops.absolute(turns[[0]]), turns[[1]] * left


def _direct(rows: Rows, ops: Operations) -> Rows:
    return rows


def _relative(rows: Rows, ops: Operations) -> Rows:
    return ops.stack(rows[[4, 5]] - rows[[0, 1]], rows[[2, 3, 6, 7]])


def _projective(rows: Rows, ops: Operations) -> Rows:
    return ops.stack(rows[[3, 7]], *_toward(rows, ops))


def _projective_turn(rows: Rows, ops: Operations) -> Rows:
    turn = ops.absolute(wrap(rows[[6]] - rows[[2]], ops))
    return ops.stack(rows[[3, 7]], *_toward(rows, ops), turn)


def _joints(rows: Rows, ops: Operations) -> Rows:
    a, wa, b, wb, ag, wag, bg, wbg = (rows[[k]] for k in range(8))
    da, db = ag - a, bg - b
    dist, v, vg = length(da, db, ops), length(wa, wb, ops), length(wag, wbg, ops)
    sight = direction(da, db, dist, 0.0, ops)
    leave = direction(wa, wb, v, sight, ops)  # at rest: the line of sight
    arrive = direction(wag, wbg, vg, sight, ops)
    return ops.stack(v, vg, dist, wrap(ops.stack(sight - leave, arrive - sight), ops))


def _joints_relative(rows: Rows, ops: Operations) -> Rows:
    places = rows[[0, 2]]
    return ops.stack(places, rows[[4, 6]] - places, rows[[1, 3, 5, 7]])


def _quantities(text: str) -> tuple[Quantity, ...]:
    return tuple(Quantity(*item.split(":")) for item in text.split())


POSE = _quantities("x:m y:m phi:rad v:m/s xg:m yg:m phig:rad vg:m/s")
JOINTS = _quantities("a:rad wa:rad/s b:rad wb:rad/s ag:rad wag:rad/s bg:rad wbg:rad/s")
TOWARD = _quantities("v:m/s v_g:m/s dist:m angle_to:rad angle_at:rad")

SPACES: dict[str, FeatureSpace] = {
    space.name: space
    for space in (
        FeatureSpace("direct", POSE, POSE, _direct),
        FeatureSpace("relative", POSE, _quantities("dx:m dy:m phi:rad v:m/s phig:rad vg:m/s"), _relative),
        FeatureSpace("projective", POSE, TOWARD, _projective),
        FeatureSpace("projective-turn", POSE, (*TOWARD, Quantity("turn", "rad")), _projective_turn),
        FeatureSpace("joints", JOINTS, _quantities("v:rad/s v_g:rad/s dist:rad angle_1:rad angle_2:rad"), _joints),
        FeatureSpace(  # for quantities that depend on the joint positions, as gravity does
            "joints-relative",
            JOINTS,
            _quantities("a:rad b:rad da:rad db:rad wa:rad/s wb:rad/s wag:rad/s wbg:rad/s"),
            _joints_relative,
        ),
    )
}
direct, relative, projective, projective_turn, joints, joints_relative = SPACES.values()
