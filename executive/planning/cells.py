"""Flaws stand in persistent lists that plans share with their parents; this takes one cell out of such a list."""

from __future__ import annotations

from typing import Any, Protocol, Self, TypeVar


class Cell(Protocol):
    """A named tuple with the cell behind it as `rest`."""

    @property
    def rest(self) -> Any:
        """The next cell; None at the end."""
        ...

    def _replace(self, *, rest: Any) -> Self: ...


C = TypeVar("C", bound=Cell)


def without(cells: C | None, gone: C) -> C | None:
    """The list without one of its cells, which must be in it; what stands behind that cell is shared."""
    before = []
    while cells is not gone:
        assert cells is not None
        before.append(cells)
        cells = cells.rest
    rest: C | None = gone.rest
    for cell in reversed(before):
        rest = cell._replace(rest=rest)
    return rest
