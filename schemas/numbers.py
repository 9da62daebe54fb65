"""Checks of received numbers: finite, and small enough that a square cannot overflow."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tailor.schemas.errors import DecodeRefusal, RefusedValueError

MAX_NUMBER = 1e15  # in any unit: ROS drivers send 1e12 for an unknown variance, and nothing needs more
# Of what a robot measures from itself, i.e. in base_link, in any unit. What a belief computes from it (a ball thrown as
# far as such a jump lets it roll) stays below MAX_NUMBER, so that reports of it can be read.
MAX_FROM_ROBOT = 1e6


def check_numbers(*values: float, most: float = MAX_NUMBER) -> None:
    """Check single numbers.

    Raises:
      RefusedValueError: A value is not finite, or its magnitude exceeds `most`.
    """
    for value in values:
        if not math.isfinite(value):
            raise RefusedValueError(DecodeRefusal.NOT_FINITE)
        if abs(value) > most:
            raise RefusedValueError(DecodeRefusal.TOO_LARGE)


def check_array(values: Any, most: float = MAX_NUMBER) -> None:
    """The same for a numpy array of any shape."""
    if not np.isfinite(values).all():
        raise RefusedValueError(DecodeRefusal.NOT_FINITE)
    if (np.abs(values) > most).any():
        raise RefusedValueError(DecodeRefusal.TOO_LARGE)


def check_variances(*values: float) -> None:
    """Raise RefusedValueError for a variance below 0."""
    if min(values) < 0.0:
        raise RefusedValueError(DecodeRefusal.NEGATIVE_VARIANCE)
