"""The one error of PDDL text: what is wrong, and where."""

from __future__ import annotations

from tailor.schemas.errors import UsageError


class PddlError(UsageError):
    """PDDL text that cannot be used; the message begins with "source:line:column: "."""


class Unsupported(PddlError):
    """PDDL that is sound but outside this planner's language; the message names the feature."""


MAX_CHARACTERS = 400  # of what is said: a file's words may be a megabyte long


def error_at(source: str, line: int, column: int, what: str) -> PddlError:
    """An error that points at one place of a text (line and column count from 1)."""
    shortened = what if len(what) <= MAX_CHARACTERS else f"{what[: MAX_CHARACTERS - 3]}..."
    return PddlError(f"{source}:{line}:{column}: {shortened}")
