"""Times as exact numbers: what a decimal number in a text says, and whole nanoseconds."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

NS_PER_S = 10**9
NANOSECOND_S = 1e-9  # times are whole nanoseconds


@lru_cache(maxsize=4096)  # a problem has few numbers, which thousands of bindings share
def exact(value: float) -> Fraction:
    """The decimal number that a float was read from."""
    return Fraction(repr(value))


def nanoseconds(time_s: float) -> int:
    """A time in whole nanoseconds."""
    return round(exact(time_s) * NS_PER_S)
