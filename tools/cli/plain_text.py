"""Text from files and the bus, escaped for a terminal; lines that may be lost."""

from __future__ import annotations

import sys
from contextlib import suppress


def plain(text: str) -> str:
    """The text in one line; control characters and unprintable ones become escapes such as \\x1b."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "surrogatepass").decode() for c in text)


def note(line: str, to_stderr: bool = False) -> None:
    """Print a line of a process that others need; it is lost where a disk is full, or nobody reads it any more."""
    with suppress(OSError):
        print(line, file=sys.stderr if to_stderr else sys.stdout, flush=True)
