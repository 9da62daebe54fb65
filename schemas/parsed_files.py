"""Reads TOML and JSON from outside: files of users, in UTF-8 whatever the locale, and texts such as a provenance."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from tailor.schemas.errors import Rejected, UsageError

T = TypeVar("T")
MAX_FILE_BYTES = 64_000_000  # far above any of them; a device such as /dev/zero has no end
MAX_ERROR = 90  # characters: a received text may be quoted in it


def read_toml(path: Path | str, expected: str) -> dict[str, Any]:
    """Read a file of TOML.

    Args:
      path: The file.
      expected: What the file should have been, for errors, e.g. "a deployment file".

    Raises:
      UsageError: The file cannot be read, or is no TOML; the message names it.
    """
    return _read(path, expected, toml_table)


def read_json(path: Path | str, expected: str) -> Any:
    """Read a file of JSON, as `read_toml`."""
    return _read(path, expected, json_value)


def toml_table(text: str) -> dict[str, Any]:
    """The table in a text of TOML.

    Raises:
      ValueError: The text is no TOML, or nested too deeply to be read.
    """
    return _parsed(tomllib.loads, text, "TOML")


def json_value(text: str) -> Any:
    """The value in a text of JSON.

    Raises:
      ValueError: The text is no JSON, or nested too deeply to be read.
    """
    return _parsed(json.loads, text, "JSON")


def table_of(text: str) -> dict[str, Any] | Rejected:
    """The JSON object in a received text; a Rejected for any other text, including endless nesting."""
    try:
        value = json_value(text)
    except ValueError as error:
        return Rejected(str(error)[:MAX_ERROR])
    return value if isinstance(value, dict) else Rejected("not a JSON object")


def shown(value: Any) -> str:
    """Text of a value for an error message: one line, at most 60 characters."""
    try:
        text = re.sub(r"\n\s*", " ", repr(value))  # of an array
    except (ValueError, RecursionError):  # an integer of more digits than Python prints, or endless nesting
        return f"a value of type {type(value).__name__} that is too long to print"
    return text if len(text) <= 60 else f"{text[:57]}..."


def _read(path: Path | str, expected: str, parse: Callable[[str], T]) -> T:
    try:
        return parse(_text(Path(path)))
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected {expected}") from error
    except UnicodeDecodeError as error:
        where = f"byte 0x{error.object[error.start]:02x} at position {error.start}"
        raise UsageError(f"{path}: not UTF-8 ({where}), expected {expected}") from None
    except ValueError as error:
        raise UsageError(f"{path}: {error}, expected {expected}") from None


def _text(path: Path) -> str:
    with path.open("rb") as file:
        data = file.read(MAX_FILE_BYTES + 1)
    if len(data) > MAX_FILE_BYTES:
        raise ValueError(f"has more than {MAX_FILE_BYTES // 10**6} MB")
    return data.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")


def _parsed(parse: Callable[[str], T], text: str, language: str) -> T:
    try:
        return parse(text)
    except ValueError as error:
        raise ValueError(f"not {language}: {error}") from None
    except RecursionError:  # some thousand brackets: the parsers of the standard library call themselves
        raise ValueError(f"not {language} that can be read: nested too deeply") from None
