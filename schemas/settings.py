"""Builds frozen dataclasses of settings from tables (TOML, JSON); reports all unknown keys and wrong types at once."""

from __future__ import annotations

import dataclasses
import types
import typing
from collections.abc import Mapping
from typing import Any, TypeVar

from tailor.schemas.errors import UsageError

T = TypeVar("T")


def from_table(cls: type[T], table: Mapping[str, Any], where: str) -> T:
    """Build a settings dataclass from a table, nested dataclasses from nested tables.

    Args:
      cls: A dataclass whose fields are numbers, strings, booleans, literals, tuples or further dataclasses.
      table: Keys and values as `tomllib` or `json` read them; missing keys keep their defaults.
      where: Source of the table for errors, e.g. a file name.

    Returns:
      An instance of `cls`.

    Raises:
      UsageError: Lists every unknown key and every value of a wrong type, in one line.
    """
    problems: list[str] = []
    made = _build(cls, table, "", problems)
    if problems:
        raise UsageError(f"{where}: " + "; ".join(problems))
    return typing.cast(T, made)


def _build(cls: type, table: Mapping[str, Any], prefix: str, problems: list[str]) -> Any:
    hints = typing.get_type_hints(cls)
    names = [f.name for f in dataclasses.fields(cls)]
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in names:
            problems.append(f"unknown key '{prefix}{key}' (expected one of: {', '.join(names)})")
        else:
            values[key] = _convert(hints[key], value, f"{prefix}{key}", problems)
    if problems:
        return None
    try:
        return cls(**values)
    except (UsageError, TypeError) as error:
        problems.append(str(error))
        return None


def _convert(hint: Any, value: Any, key: str, problems: list[str]) -> Any:
    origin = typing.get_origin(hint)
    if dataclasses.is_dataclass(hint) and isinstance(value, Mapping):
        return _build(typing.cast(type, hint), value, f"{key}.", problems)
    if origin is typing.Literal:
        if value in typing.get_args(hint):
            return value
        problems.append(f"'{key}' is {value!r}, expected one of: {', '.join(map(str, typing.get_args(hint)))}")
    elif origin is tuple and isinstance(value, list | tuple):
        item = typing.get_args(hint)
        hints = [item[0]] * len(value) if item[-1] is Ellipsis else list(item)
        if len(hints) == len(value):
            return tuple(_convert(h, v, key, problems) for h, v in zip(hints, value, strict=True))
        problems.append(f"'{key}' is {value!r}, expected {len(hints)} values")
    elif origin in (types.UnionType, typing.Union):
        return None if value is None else _convert(typing.get_args(hint)[0], value, key, problems)
    elif hint is float and isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    elif isinstance(hint, type) and isinstance(value, hint) and not (hint is int and isinstance(value, bool)):
        return value
    else:
        problems.append(f"'{key}' is {value!r}, expected {getattr(hint, '__name__', hint)}")
    return None
