"""Words that come from files and the bus, made fit for a terminal."""

from __future__ import annotations


def plain(text: str) -> str:
    """The text in one line: what a terminal would obey, or not show, is written as an escape such as \\x1b."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "surrogatepass").decode() for c in text)
