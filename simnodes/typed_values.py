"""Values of a table that people wrote; one that is missing or of another type is refused with its key."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

from tailor.schemas.parsed_files import shown

Table = Mapping[str, Any]


def finite_number(table: Table, key: str) -> float:
    """The finite number of a key; ValueError for anything else, and if there is no such key."""
    value = _value(table, key, "a finite number")
    if type(value) not in (int, float) or not abs(value) <= sys.float_info.max:
        raise ValueError(f"{key} is {shown(value)}, expected a finite number")
    return float(value)


def text(table: Table, key: str) -> str:
    """The text of a key, as `finite_number`."""
    value = _value(table, key, "text")
    if not isinstance(value, str):
        raise ValueError(f"{key} is {shown(value)}, expected text")
    return value


def table_in(table: Table, key: str) -> Table:
    """The table of a key, as `finite_number`."""
    value = _value(table, key, "a table")
    if not isinstance(value, dict):
        raise ValueError(f"{key} is {shown(value)}, expected a table")
    return value


def tables_in(table: Table, key: str) -> list[Table]:
    """The list of tables of a key, at least one, as `finite_number`."""
    value = _value(table, key, "a list of tables")
    if not isinstance(value, list) or not value or not all(isinstance(each, dict) for each in value):
        raise ValueError(f"{key} is {shown(value)}, expected a list of tables, at least one")
    return value


def _value(table: Table, key: str, expected: str) -> Any:
    if key not in table:
        raise ValueError(f"{key} is missing, expected {expected}")
    return table[key]
