"""Builds frozen dataclasses of settings from tables (TOML, JSON); reports all unknown keys and wrong types at once."""

from __future__ import annotations

import dataclasses
import types
import typing
from collections.abc import Mapping
from typing import Any, TypeVar

from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import shown

T = TypeVar("T")
MAX_INTEGER = 2**63 - 1  # as TOML promises; larger ones overflow floats, and fill a message with digits


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
    for field in dataclasses.fields(cls):
        if field.name not in table and field.default is field.default_factory is dataclasses.MISSING:
            problems.append(f"'{prefix}{field.name}' is missing, expected {_name_of(hints[field.name])}")
    if problems:
        return None
    try:
        return cls(**values)
    except (UsageError, TypeError) as error:
        problems.append(str(error))
        return None


def _convert(hint: Any, value: Any, key: str, problems: list[str]) -> Any:
    origin, known = typing.get_origin(hint), typing.get_args(hint)
    if isinstance(value, int) and abs(value) > MAX_INTEGER:
        problems.append(f"'{key}' is {shown(value)}, expected a number of at most 64 bits")
        return None
    if dataclasses.is_dataclass(hint) and isinstance(value, Mapping):
        return _build(typing.cast(type, hint), value, f"{key}.", problems)
    if origin is typing.Literal:
        if value in known:
            return value
        problems.append(f"'{key}' is {shown(value)}, expected {_name_of(hint)}")
    elif origin is tuple and isinstance(value, list | tuple):
        hints = [known[0]] * len(value) if known[-1] is Ellipsis else list(known)
        if len(hints) == len(value):
            return tuple(_convert(h, v, key, problems) for h, v in zip(hints, value, strict=True))
        problems.append(f"'{key}' is {shown(value)}, expected {len(hints)} values")
    elif origin in (types.UnionType, typing.Union):
        return None if value is None else _convert(known[0], value, key, problems)
    elif hint is float and isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    elif isinstance(hint, type) and isinstance(value, hint) and not (hint is int and isinstance(value, bool)):
        return value
    else:
        problems.append(f"'{key}' is {shown(value)}, expected {_name_of(hint)}")
    return None


def _name_of(hint: Any) -> str:
    """A type in an error message, by the words of a table's author and not by our classes."""
    if dataclasses.is_dataclass(hint):
        return "a table"
    if typing.get_origin(hint) is tuple:
        return "a list"
    if typing.get_origin(hint) is typing.Literal:
        return f"one of: {', '.join(map(str, typing.get_args(hint)))}"
    return str(getattr(hint, "__name__", hint))
