"""Where tables are printed."""

from __future__ import annotations

from rich.console import Console

PIPE_WIDTH = 140  # a file or a pipe has no width of its own, and must not squeeze a table as a small screen does


def table_console() -> Console:
    """A console for tables: as wide as the terminal, or wide enough where there is none.

    What stands in a table was recorded or read from a file: it is no markup.
    """
    console = Console(markup=False, highlight=False)
    if not console.is_terminal:
        console.width = PIPE_WIDTH
    return console
