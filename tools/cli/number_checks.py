"""Number types for argparse: an impossible number is reported in one line, before anything starts."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import shown
from tailor.schemas.settings import MAX_INTEGER


def at_least(minimum: int, flag: str) -> Callable[[str], int]:
    """`type` for argparse: integers from `minimum` up; raises UsageError that names the flag."""

    def read(text: str) -> int:
        value = _integer(text, flag, f"a whole number, at least {minimum}")
        return checked(value, minimum, flag)

    return read


def add_count(
    parser: argparse.ArgumentParser, flag: str, minimum: int, default: int, text: str, **options: Any
) -> None:
    """Declare a flag for a whole number from `minimum` up, whose help ends with the default."""
    text += " (default %(default)s)"
    parser.add_argument(flag, type=at_least(minimum, flag), default=default, help=text, **options)


def checked(value: int, minimum: int, flag: str) -> int:
    """The value itself; raises UsageError that names the flag if it is below `minimum`, or has more than 64 bits."""
    if value < minimum:
        raise UsageError(f"{flag} is {value}, expected at least {minimum}")
    if value > MAX_INTEGER:  # a recording of a run with it could not be read as settings again
        raise UsageError(f"{flag} is {shown(value)}, expected a number of at most 64 bits")
    return value


def check_within(value: float, maximum: float, flag: str) -> None:
    """Raise UsageError that names the flag unless 0 <= value <= maximum; NaN raises, too."""
    if not 0 <= value <= maximum:
        raise UsageError(f"{flag} is {value:g}, expected 0 to {maximum:g}")


MAX_PROCESSES = 1000  # each takes some 100 MB


def processes(text: str) -> int:
    """`type` for --jobs: from 1 up, or -1 for one process per core, as in joblib; raises UsageError."""
    value = _integer(text, "--jobs", "a number of processes")
    if value < 1 and value != -1:
        raise UsageError(f"--jobs is {value}, expected at least 1, or -1 for every core")
    if value > MAX_PROCESSES:
        raise UsageError(f"--jobs is {value}, expected at most {MAX_PROCESSES}")
    return value


def finite(flag: str) -> Callable[[str], float]:
    """`type` for argparse: finite numbers from 0 up; raises UsageError that names the flag."""

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or value < 0:
            raise UsageError(f"{flag} is '{text}', expected a number, at least 0")
        return value

    return read


def _integer(text: str, flag: str, expected: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise UsageError(f"{flag} is '{text}', expected {expected}") from None
