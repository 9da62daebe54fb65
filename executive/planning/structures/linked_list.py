"""Flaws stand in persistent lists that plans share with their parents: reads such a list, takes one cell out of it."""

from __future__ import annotations

from typing import Any, Protocol, TypeVar


class Cell(Protocol):
    """A named tuple with the cell behind it as its last field, `rest`."""

    @property
    def rest(self) -> Any:
        """The next cell; None at the end."""
        ...

    def __getitem__(self, fields: slice) -> tuple[Any, ...]: ...


C = TypeVar("C", bound=Cell)
_new: Any = tuple.__new__  # makes a named tuple in a third of the time of its `_replace`


def cells_of(cells: C | None) -> list[C]:
    """The cells of a list, the newest first."""
    found = []
    while cells is not None:
        found.append(cells)
        cells = cells.rest
    return found


def without(cells: C | None, gone: C) -> C | None:
    """The list without one of its cells, which must be in it; what stands behind that cell is shared."""
    before = []
    while cells is not gone:
        assert cells is not None
        before.append(cells)
        cells = cells.rest
    rest: C | None = gone.rest
    for cell in reversed(before):
        rest = _new(type(cell), (*cell[:-1], rest))
    return rest
