"""Text of a reason: the value of its enum, and the detail."""

from __future__ import annotations

import re

_NUMBER = re.compile(r"(?<!\w)-?\d+(\.\d+)?(e[+-]?\d+)?(?!\w)")


def reason_text(reason: str, detail: str) -> str:
    """The reason for people, e.g. `reason_text("driver fault", "motor 2") == "driver fault: motor 2"`."""
    return ": ".join(text for text in (reason, detail) if text)


def result_text(result: str, reason: str, detail: str) -> str:
    """The result of a task for people, e.g. "achieved" or "failed: no subgoal: approachBall"; "" while it is open."""
    return reason_text(result, reason_text(reason, detail))


def without_numbers(text: str) -> str:
    """The text with its numbers left open: texts that differ in nothing else are of one event."""
    return _NUMBER.sub("#", text)
