"""Whether values out of a JSON file have the shape that is expected of them: what cards and manifests share."""

from __future__ import annotations

import math
from typing import Any


def arguments_error(said: Any) -> str:
    """What is wrong with the arguments that a card or a manifest declares; empty if nothing is."""
    if not isinstance(said, list) or not said:
        return f"arguments is {short(said)}, expected a list of name, unit, lower, upper"
    for each in said:
        named = isinstance(each, dict) and all(isinstance(each.get(key), str) for key in ("name", "unit"))
        if not named or not is_range([each.get("lower"), each.get("upper")]):
            return f"argument {short(each)}, expected name, unit, and numbers lower <= upper"
    return ""


def is_number(value: Any) -> bool:
    """Whether it is a finite number; JSON of Python's making may hold NaN."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def is_range(value: Any) -> bool:
    """Whether it is a pair of numbers, the lower one first."""
    return isinstance(value, list) and len(value) == 2 and all(map(is_number, value)) and value[0] <= value[1]


def short(value: Any) -> str:
    """How an error says a value: on one line that stays readable."""
    said = repr(value)
    return said if len(said) <= 60 else f"{said[:57]}..."
