"""Progress bars of evaluations, on stderr: JSON on stdout stays whole."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sized
from typing import TypeVar

from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn

from tailor.tools.parallel.progress_lines import ProgressLines

Item = TypeVar("Item")


def tracked(items: Iterable[Item], title: str, total: int | None = None) -> Iterator[Item]:
    """The items, with a bar that grows as they are taken and disappears at the end; without a terminal, with lines.

    Args:
      items: As they come.
      title: Beside the bar.
      total: Number of items; None: their length.
    """
    if total is None and isinstance(items, Sized):
        total = len(items)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    lines, done = ProgressLines(), 0
    with lines.bars(*columns, transient=True) as progress:
        lines.report(title, done, total)
        for done, item in enumerate(progress.track(items, total=total, description=title), 1):
            yield item
            lines.report(title, done, total)
