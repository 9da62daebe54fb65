"""Which field of a ROS value holds a number that is not finite, for the people who have to find its publisher."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

MAX_INDEX = 99  # further elements are not told apart: whoever counts refusals by field must not grow


def not_finite_field(value: Any) -> str:
    """Path of the first number that is not finite, e.g. "pose.covariance[7]"; empty without any."""
    return next(_not_finite(value, ""), "")


def _not_finite(value: Any, path: str) -> Iterator[str]:
    if isinstance(value, float):
        if not math.isfinite(value):
            yield path
    elif is_dataclass(value):
        for field in fields(value):
            if not field.name.startswith("__"):  # rosbags notes the type there
                yield from _not_finite(getattr(value, field.name), f"{path}.{field.name}" if path else field.name)
    elif not isinstance(value, str | bytes | int) and hasattr(value, "__iter__"):
        for index, element in enumerate(value.tolist() if hasattr(value, "tolist") else value):
            yield from _not_finite(element, f"{path}[{index if index <= MAX_INDEX else '…'}]")
