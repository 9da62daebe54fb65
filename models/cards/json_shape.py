"""Shape checks of JSON values, shared by cards and manifests."""

from __future__ import annotations

import sys
from typing import Any

from tailor.schemas.parsed_files import shown

MAX_QUANTITY = 1e9  # metres, seconds, joules: features are of single precision, which the square of 1e20 exceeds


def arguments_error(value: Any) -> str:
    """First error in the arguments that a card or a manifest declares; empty if there is none."""
    if not isinstance(value, list) or not value:
        return f"arguments is {shown(value)}, expected a list of name, unit, lower, upper"
    for each in value:
        named = isinstance(each, dict) and all(isinstance(each.get(key), str) for key in ("name", "unit"))
        ends = [each.get("lower"), each.get("upper")] if named else []
        if not is_range(ends):
            return f"argument {shown(each)}, expected name, unit, and numbers lower <= upper"
        if max(map(abs, ends)) > MAX_QUANTITY:
            return f"argument {shown(each)}, expected numbers from {-MAX_QUANTITY:g} to {MAX_QUANTITY:g}"
    names = [each["name"] for each in value]
    repeated = sorted({name for name in names if names.count(name) > 1})
    return f"argument {repeated[0]} is there twice, expected once" if repeated else ""


def is_number(value: Any) -> bool:
    """Whether a value is a finite number; Python's JSON may hold NaN, and integers beyond the range of floats."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def are_rows(value: Any, width: int) -> bool:
    """Whether a value is a list of lists of that many finite numbers."""
    rows = isinstance(value, list) and all(isinstance(row, list) and len(row) == width for row in value)
    return rows and all(is_number(each) for row in value for each in row)


def is_count(value: Any) -> bool:
    """Whether a value is a whole number, at least 0."""
    return type(value) is int and value >= 0


def is_range(value: Any) -> bool:
    """Whether a value is a pair of finite numbers, the lower one first."""
    return isinstance(value, list) and len(value) == 2 and all(map(is_number, value)) and value[0] <= value[1]
