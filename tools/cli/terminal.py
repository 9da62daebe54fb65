"""Console for tables."""

from __future__ import annotations

from rich.console import Console

PIPE_WIDTH = 140  # a pipe has no width; rich would assume 80 columns and squeeze the table


def table_console() -> Console:
    """Console as wide as the terminal, or PIPE_WIDTH without one.

    Markup is off: the content of a table comes from recordings and files.
    """
    console = Console(markup=False, highlight=False)
    if not console.is_terminal:
        console.width = PIPE_WIDTH
    return console
