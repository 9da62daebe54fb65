"""Feature spaces of the action models (Table 7): pure functions of action parameters, one definition for all uses.

Training calls them on arrays, export on symbols of an ONNX graph. Only operations that IEEE 754 rounds exactly are
used, in single precision and in one order: numpy and the ONNX runtime give the same bits, on thresholds too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
Column = Any  # an array of shape (n,), or a symbol of the exported graph; both know + - * / and <

TWO_PI = 2 * np.pi
SAME_PLACE = 1e-6  # m (or rad): nearer than this there is no line of sight
# 2 atan(t) = t·P(t²) on [-1, 1], Chebyshev-fitted by us: at most 3.5e-6 rad off, far below any pose noise
HALF_ANGLE = (1.99995444, -0.66524565, 0.38708072, -0.23285288, 0.10529461, -0.02343823)


class Operations(Protocol):
    """What a feature may use besides arithmetic; numpy and the ONNX exporter each provide it."""

    def sqrt(self, a: Column) -> Column:
        """Square root."""

    def absolute(self, a: Column) -> Column:
        """Magnitude."""

    def round(self, a: Column) -> Column:
        """Nearest whole number, ties to even."""

    def maximum(self, a: Column, floor: float) -> Column:
        """The larger of each element and a number."""

    def where(self, condition: Column, a: Column, b: Column) -> Column:
        """Elements of `a` where the condition holds, of `b` elsewhere."""


class _Numpy:
    sqrt = staticmethod(np.sqrt)
    absolute = staticmethod(np.absolute)
    round = staticmethod(np.round)
    where = staticmethod(np.where)

    @staticmethod
    def maximum(a: Column, floor: float) -> Column:
        return np.maximum(a, np.float32(floor))


NUMPY: Operations = _Numpy()


@dataclass(frozen=True, slots=True)
class Quantity:
    """A named number with its unit: a column of arguments or of features."""

    name: str
    unit: str


@dataclass(frozen=True, slots=True)
class FeatureSpace:
    """A map from an action's arguments to what a model sees.

    `columns` is traced for export: it may use arithmetic and the `Operations` alone.
    """

    name: str
    arguments: tuple[Quantity, ...]
    features: tuple[Quantity, ...]
    columns: Callable[[tuple[Column, ...], Operations], tuple[Column, ...]]

    def __call__(self, arguments: Array) -> NDArray[np.float32]:
        """Features of arguments: shape (n, k) to (n, f), single precision.

        Raises:
          ValueError: the arguments have another number of columns.
        """
        if arguments.ndim != 2 or arguments.shape[1] != len(self.arguments):
            raise ValueError(f"{self.name} takes (n, {len(self.arguments)}) arguments, got {arguments.shape}")
        with np.errstate(invalid="ignore"):  # a NaN argument gives NaN features, which the models call invalid
            columns = self.columns(tuple(np.asarray(arguments, np.float32).T), NUMPY)
        return np.stack(columns, axis=1)


def wrap(a: Column, ops: Operations) -> Column:
    """The paper's norm(a): the angle plus or minus whole turns, in [-pi, pi]."""
    return a - ops.round(a * (1 / TWO_PI)) * TWO_PI


def length(dx: Column, dy: Column, ops: Operations) -> Column:
    """Euclidean length of (dx, dy)."""
    return ops.sqrt(dx * dx + dy * dy)


def direction(dx: Column, dy: Column, dist: Column, otherwise: Column, ops: Operations) -> Column:
    """atan2(dy, dx) up to whole turns; `otherwise` where the length `dist` is (almost) zero.

    By half angles: tan(θ/2) = dy / (dist + |dx|) never cancels.
    """
    t = dy / ops.maximum(dist + ops.absolute(dx), 1e-30)
    s = t * t
    polynomial = s * HALF_ANGLE[-1] + HALF_ANGLE[-2]
    for coefficient in HALF_ANGLE[-3::-1]:
        polynomial = polynomial * s + coefficient
    ahead = polynomial * t
    return ops.where(dist < SAME_PLACE, otherwise, ops.where(dx < 0.0, np.pi - ahead, ahead))


def _toward(columns: tuple[Column, ...], ops: Operations) -> tuple[Column, Column, Column]:
    """Distance, |angle to the goal| and signed angle at the goal.

    The angle at the goal is positive when the robot must turn the same way twice (an S-curve is negative). At zero
    distance the line of sight is the robot's own heading: what is left is a turn on the spot. Straight ahead
    (angle_to = 0) counts as a left turn.
    """
    x, y, phi, _, xg, yg, phig, _ = columns
    dx, dy = xg - x, yg - y
    dist = length(dx, dy, ops)
    sight = direction(dx, dy, dist, phi, ops)
    to, at = wrap(sight - phi, ops), wrap(phig - sight, ops)
    return dist, ops.absolute(to), ops.where(to < 0.0, 0.0 - at, at)


def _direct(columns: tuple[Column, ...], ops: Operations) -> tuple[Column, ...]:
    return columns


def _relative(columns: tuple[Column, ...], ops: Operations) -> tuple[Column, ...]:
    x, y, phi, v, xg, yg, phig, vg = columns
    return xg - x, yg - y, phi, v, phig, vg


def _projective(columns: tuple[Column, ...], ops: Operations) -> tuple[Column, ...]:
    return (columns[3], columns[7], *_toward(columns, ops))


def _projective_turn(columns: tuple[Column, ...], ops: Operations) -> tuple[Column, ...]:
    turn = ops.absolute(wrap(columns[6] - columns[2], ops))
    return (*_projective(columns, ops), turn)


def _joints(columns: tuple[Column, ...], ops: Operations) -> tuple[Column, ...]:
    a, wa, b, wb, ag, wag, bg, wbg = columns
    da, db = ag - a, bg - b
    dist, v, vg = length(da, db, ops), length(wa, wb, ops), length(wag, wbg, ops)
    sight = direction(da, db, dist, 0.0, ops)
    leave = direction(wa, wb, v, sight, ops)  # at rest it leaves along the line of sight
    arrive = direction(wag, wbg, vg, sight, ops)
    return v, vg, dist, wrap(sight - leave, ops), wrap(arrive - sight, ops)


def _joints_relative(columns: tuple[Column, ...], ops: Operations) -> tuple[Column, ...]:
    a, wa, b, wb, ag, wag, bg, wbg = columns
    return a, b, ag - a, bg - b, wa, wb, wag, wbg


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
        FeatureSpace(  # for what depends on where the joints are, as gravity does
            "joints-relative",
            JOINTS,
            _quantities("a:rad b:rad da:rad db:rad wa:rad/s wb:rad/s wag:rad/s wbg:rad/s"),
            _joints_relative,
        ),
    )
}
direct, relative, projective, projective_turn, joints, joints_relative = SPACES.values()
