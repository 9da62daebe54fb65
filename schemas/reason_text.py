"""Text of a reason: the value of its enum, and the detail."""

from __future__ import annotations


def reason_text(reason: str, detail: str) -> str:
    """The reason for people, e.g. `reason_text("driver fault", "motor 2") == "driver fault: motor 2"`."""
    return f"{reason}: {detail}" if detail else reason
