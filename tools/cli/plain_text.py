"""Text from files and the bus, escaped for a terminal."""

from __future__ import annotations


def plain(text: str) -> str:
    """The text in one line; control characters and unprintable ones become escapes such as \\x1b."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "surrogatepass").decode() for c in text)
