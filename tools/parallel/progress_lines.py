"""Progress as lines on standard error, where no terminal shows bars: of a log that says nothing nobody knows whether
the work goes on."""

from __future__ import annotations

import time
from collections.abc import Callable

from rich.console import Console
from rich.progress import Progress, ProgressColumn

EVERY_S = 60.0  # at most so often between the start and the end of a step


class ProgressLines:
    """Prints the start and the end of each step, and its progress once a minute; on a terminal there are bars."""

    def __init__(self, quiet: bool = False, clock: Callable[[], float] = time.monotonic) -> None:
        self._console = Console(stderr=True)
        self._bars = not quiet and self._console.is_terminal
        self._lines = not quiet and not self._bars
        self._clock, self._printed_at, self._printed = clock, clock(), ("", 0)

    def bars(self, *columns: ProgressColumn, transient: bool = False) -> Progress:
        """Bars that are shown on a terminal only, where no lines are printed."""
        return Progress(*columns, console=self._console, transient=transient, disable=not self._bars)

    def report(self, title: str, done: int, total: int | None) -> None:
        """Print that `done` of `total` parts of a step are done, if that is due."""
        due = title != self._printed[0] or done == total or self._clock() - self._printed_at >= EVERY_S
        if not self._lines or not due or total == 0 or (title, done) == self._printed:
            return
        self._printed_at, self._printed = self._clock(), (title, done)
        text = f"{title}: {done}" + ("" if total is None else f" of {total}")
        self._console.print(text, markup=False, highlight=False, soft_wrap=True)
