"""Which numbers of a message may come in: finite ones, and none so large that a square of it might overflow."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tailor.schemas.ros_time import Refusal

MOST = 1e15  # of anything: ROS drivers say 1e12 for a variance that they do not know, and no unit needs more


def check_numbers(*values: float) -> None:
    """Raise Refusal for a value that is not finite, or larger than MOST."""
    for value in values:
        if not math.isfinite(value):
            raise Refusal("not finite")
        if abs(value) > MOST:
            raise Refusal("number too large")


def check_array(values: Any) -> None:
    """The same for an array of any shape."""
    if not np.isfinite(values).all():
        raise Refusal("not finite")
    if (np.abs(values) > MOST).any():
        raise Refusal("number too large")


def check_variances(*values: float) -> None:
    """Raise Refusal for a variance below 0."""
    if min(values) < 0.0:
        raise Refusal("negative variance")
