"""Errors of PDDL text, with file, line and column."""

from __future__ import annotations

from tailor.schemas.errors import UsageError


class PddlError(UsageError):
    """PDDL text that cannot be used; the message begins with "source:line:column: "."""


class Unsupported(PddlError):
    """Valid PDDL outside this planner's language; the message names the feature."""


MAX_CHARACTERS = 400  # of an error message: a word of a file may be a megabyte long


def error_at(source: str, line: int, column: int, what: str) -> PddlError:
    """An error at one place of a text; line and column count from 1."""
    shortened = what if len(what) <= MAX_CHARACTERS else f"{what[: MAX_CHARACTERS - 3]}..."
    return PddlError(f"{source}:{line}:{column}: {shortened}")
