"""Progress bars of evaluations, on stderr."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeVar

from rich.console import Console
from rich.progress import track

Item = TypeVar("Item")


def tracked(items: Sequence[Item], title: str) -> Iterator[Item]:
    """The items, with a bar that grows as they are taken; it disappears at the end."""
    yield from track(items, title, console=Console(stderr=True), transient=True)
