"""Lists of names in a line of text."""

from __future__ import annotations

from collections.abc import Sequence


def abbreviated(names: Sequence[str], most: int, separator: str = ", ") -> str:
    """At most so many names, and how many more there are: `abbreviated("abc", 2) == "a, b and 1 more"`."""
    rest = f" and {len(names) - most} more" if len(names) > most else ""
    return separator.join(names[:most]) + rest
