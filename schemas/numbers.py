"""Checks of received numbers: finite, and small enough that a square cannot overflow."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tailor.schemas.errors import DecodeRefusal, RefusedValueError

MAX_NUMBER = 1e15  # in any unit: ROS drivers send 1e12 for an unknown variance, and nothing needs more


def check_numbers(*values: float) -> None:
    """Check single numbers.

    Raises:
      RefusedValueError: A value is not finite, or its magnitude exceeds MAX_NUMBER.
    """
    for value in values:
        if not math.isfinite(value):
            raise RefusedValueError(DecodeRefusal.NOT_FINITE)
        if abs(value) > MAX_NUMBER:
            raise RefusedValueError(DecodeRefusal.TOO_LARGE)


def check_array(values: Any) -> None:
    """The same for a numpy array of any shape."""
    if not np.isfinite(values).all():
        raise RefusedValueError(DecodeRefusal.NOT_FINITE)
    if (np.abs(values) > MAX_NUMBER).any():
        raise RefusedValueError(DecodeRefusal.TOO_LARGE)


def check_variances(*values: float) -> None:
    """Raise RefusedValueError for a variance below 0."""
    if min(values) < 0.0:
        raise RefusedValueError(DecodeRefusal.NEGATIVE_VARIANCE)
