"""Errors of PDDL text, with file, line and column."""

from __future__ import annotations

import re

from tailor.schemas.errors import UsageError


class PddlError(UsageError):
    """PDDL text that cannot be used; the message begins with "source:line:column: "."""


class Unsupported(PddlError):
    """Valid PDDL outside this planner's language; the message names the feature."""


MAX_CHARACTERS = 400  # of an error message: a word of a file may be a megabyte long


MAX_TOKEN = 60  # characters of one word in a message


def shortened(text: str) -> str:
    """A message with its long words cut."""
    text = re.sub(rf"\S{{{MAX_TOKEN + 1},}}", lambda word: f"{word[0][: MAX_TOKEN - 3]}...", text)
    return text if len(text) <= MAX_CHARACTERS else f"{text[: MAX_CHARACTERS - 3]}..."


LINE_END = re.compile(r"\r\n|\r|\n")


def place_of(text: str, position: int) -> tuple[int, int]:
    """Line and column of a position in a text, both from 1; any of the three line ends counts."""
    *before, line = LINE_END.split(text[:position])
    return len(before) + 1, len(line) + 1


def error_at(source: str, line: int, column: int, what: str) -> PddlError:
    """An error at one place of a text; line and column count from 1."""
    return PddlError(f"{source}:{line}:{column}: {shortened(what)}")
