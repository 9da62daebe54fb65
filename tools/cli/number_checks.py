"""Numbers that a command line asks for: one that cannot be is told in one line, before anything starts."""

from __future__ import annotations

import math
from collections.abc import Callable

from tailor.schemas.errors import UsageError


def at_least(least: int, flag: str) -> Callable[[str], int]:
    """A `type` for argparse: whole numbers from `least` up; raises UsageError naming the flag."""

    def read(text: str) -> int:
        value = _whole(text, flag, f"a whole number, at least {least}")
        return checked(value, least, flag)

    return read


def checked(value: int, least: int, flag: str) -> int:
    """The value itself; raises UsageError naming the flag where it is below `least`."""
    if value < least:
        raise UsageError(f"{flag} is {value}, expected at least {least}")
    return value


def check_within(value: float, most: float, flag: str) -> None:
    """Raises UsageError naming the flag where a value is not from 0 to `most`, as NaN is not."""
    if not 0 <= value <= most:
        raise UsageError(f"{flag} is {value:g}, expected 0 to {most:g}")


def processes(text: str) -> int:
    """A `type` for --jobs: from 1 up, or -1 for every core, as joblib counts them; raises UsageError."""
    value = _whole(text, "--jobs", "a number of processes")
    if value < 1 and value != -1:
        raise UsageError(f"--jobs is {value}, expected at least 1, or -1 for every core")
    return value


def finite(flag: str) -> Callable[[str], float]:
    """A `type` for argparse: numbers that are neither infinite nor none, from 0 up; raises UsageError."""

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or value < 0:
            raise UsageError(f"{flag} is '{text}', expected a number, at least 0")
        return value

    return read


def _whole(text: str, flag: str, expected: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise UsageError(f"{flag} is '{text}', expected {expected}") from None
