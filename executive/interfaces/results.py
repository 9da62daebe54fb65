"""Checks of what code of a robot's package returns, where the result enters.

Unchecked, a forgotten `return` passes the type hints unseen and shows up anywhere in code of ours. No retry would
correct it, so each is a UsageError in one line: what was called, what it returned, what is expected.
"""

from __future__ import annotations

from collections.abc import Callable
from numbers import Real
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import shown


def wrong_result(called: str, result: Any, expected: str, which: str = "") -> UsageError:
    """The error for people; `called` names package and function, `which` a part of the result, e.g. "the fact "."""
    return UsageError(f"{called} returned {which}{shown(result)}, expected {expected}")


def name_of(function: Callable[..., Any]) -> str:
    """Module and name of a package's function, or of the class of a callable object, such as "cart.actions.rows"."""
    named: Any = function if hasattr(function, "__qualname__") else type(function)
    return f"{named.__module__}.{named.__qualname__}"


def is_row_of_numbers(value: Any) -> bool:
    """Whether a value is a tuple, a list or a one-dimensional array of real numbers."""
    if not isinstance(value, tuple | list) and getattr(value, "ndim", 0) != 1:
        return False
    return all(type(each) is float or isinstance(each, Real) for each in value)  # the first takes a tenth of the time
