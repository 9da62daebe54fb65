"""Shape checks of JSON values, shared by cards and manifests."""

from __future__ import annotations

import math
from typing import Any


def arguments_error(value: Any) -> str:
    """First error in the arguments that a card or a manifest declares; empty if there is none."""
    if not isinstance(value, list) or not value:
        return f"arguments is {short(value)}, expected a list of name, unit, lower, upper"
    for each in value:
        named = isinstance(each, dict) and all(isinstance(each.get(key), str) for key in ("name", "unit"))
        if not named or not is_range([each.get("lower"), each.get("upper")]):
            return f"argument {short(each)}, expected name, unit, and numbers lower <= upper"
    return ""


def is_number(value: Any) -> bool:
    """Whether a value is a finite number; Python's JSON may hold NaN."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def is_range(value: Any) -> bool:
    """Whether a value is a pair of finite numbers, the lower one first."""
    return isinstance(value, list) and len(value) == 2 and all(map(is_number, value)) and value[0] <= value[1]


def short(value: Any) -> str:
    """Text of a value for an error message, at most 60 characters."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
