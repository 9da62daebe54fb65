"""Checks that what a part says of whole episodes is the same in each of their rows, of which only the first is read.

A column of the time that remains, say, would else be taken for durations.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tailor.schemas.errors import UsageError

if TYPE_CHECKING:
    import pyarrow as pa

REPEATED = ("duration_s", "success", "finished", "failure", "in_context")


def check_repeated(table: pa.Table, names: Sequence[str], path: Path) -> None:
    """Check columns whose types are checked.

    Args:
      table: Of one part.
      names: Names of the arguments.
      path: Its file, for errors.

    Raises:
      UsageError: A value of an episode is not the same in each of its rows.
    """
    numbers = table["episode"].to_numpy()
    same = numbers[1:] == numbers[:-1]
    for name in (*REPEATED, *(f"asked_{name}" for name in names)):
        if name not in table.column_names:
            continue
        values = _comparable(table[name].combine_chunks(), name)
        changed = np.flatnonzero(same & (values[1:] != values[:-1]))
        if len(changed):
            before, now = (table[name][int(changed[0]) + k].as_py() for k in (0, 1))
            where = f"in row {changed[0] + 1}, of episode {numbers[changed[0]]}"
            raise UsageError(f"{path}: column {name} holds {now!r} {where}, expected {before!r} as in the row before")


def _comparable(column: Any, name: str) -> Any:
    """Values of a column as an array; of text the numbers of its words, as it takes little memory."""
    return column.dictionary_encode().indices.to_numpy() if name == "failure" else column.to_numpy(zero_copy_only=False)
