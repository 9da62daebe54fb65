"""Reads the Parquet parts of a data set; they may come from others, so every column is checked."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tailor.models.cards.json_shape import MAX_QUANTITY
from tailor.models.episodes.repeated_values import check_repeated
from tailor.schemas.errors import UsageError

if TYPE_CHECKING:
    import pyarrow as pa
    import pyarrow.parquet as pq

WORK, IN_CONTEXT, FAILURE = "work_j", "in_context", "failure"
# columns beside the numbers to learn from: check of the type in pyarrow.types, and the type in words
PER_EPISODE = {
    "episode": ("is_integer", "integers"),
    "success": ("is_boolean", "true or false"),
    "finished": ("is_boolean", "true or false"),
    FAILURE: ("is_string", "text"),
    "tick": ("is_integer", "integers"),
    IN_CONTEXT: ("is_boolean", "true or false"),
}
OPTIONAL = (WORK, IN_CONTEXT)  # older data sets lack them
MAX_ROWS = 2_000_000  # two days at 10 Hz; a megabyte may hold billions, which memory does not
MAX_BYTES = 2_000_000_000  # of such rows, each with some hundred bytes


def parts_of(folder: Path) -> list[Path]:
    """The parts of a data set, in order.

    Raises:
      UsageError: One is no file: a named pipe would be waited for, and a device has no end.
    """
    found = sorted(folder.glob("part-*.parquet"))
    for path in found:
        if not path.is_file():
            raise UsageError(f"{path}: is no file, expected a part of a data set")
    return found


def parts_sha256(folder: Path) -> str:
    """SHA-256 of all parts of a data set, as cards name it; a UsageError as of `parts_of`."""
    digest = hashlib.sha256()
    for path in parts_of(folder):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def read_part(path: Path, names: Sequence[str]) -> pa.Table:
    """Read and check one part.

    Args:
      path: The file.
      names: Names of the arguments.

    Raises:
      UsageError: It cannot be read, is damaged, lacks a column, or holds a value of another type.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    numbers = [*names, *(f"asked_{name}" for name in names), "duration_s"]
    try:
        metadata = pq.read_metadata(path)
        _check_extent(metadata, path)
        present = set(metadata.schema.to_arrow_schema().names)
        wanted = [name for name in (*PER_EPISODE, *numbers, WORK) if name in present or name not in OPTIONAL]
        missing = [name for name in wanted if name not in present]
        if missing or not metadata.num_rows:
            raise UsageError(f"{path}: lacks {', '.join(missing) or 'rows'}, expected a part of a data set")
        columns = list(dict.fromkeys(wanted))  # of others nothing is read
        table = pq.read_table(path, columns=columns, read_dictionary=[FAILURE], page_checksum_verification=True)
        table.validate(full=True)  # text that is not UTF-8, say
        table = _with_text_in_rows(table, path)
    except (pa.ArrowException, OSError) as error:
        first = str(error).partition("\n")[0]  # others list the columns
        raise UsageError(f"{path}: cannot be read ({first}), expected a part of a data set") from None
    _check_columns(table, numbers, path)
    check_repeated(table, names, path)
    return table


def _check_extent(metadata: pq.FileMetaData, path: Path) -> None:
    """Raise UsageError if a part is too large, which its compressed file does not tell."""
    if metadata.num_rows > MAX_ROWS:
        raise UsageError(f"{path}: has {metadata.num_rows} rows, expected at most {MAX_ROWS} in a part of a data set")
    size = sum(metadata.row_group(k).total_byte_size for k in range(metadata.num_row_groups))
    if size > MAX_BYTES:
        raise UsageError(f"{path}: holds {size} bytes, expected at most {MAX_BYTES} in a part of a data set")


def _with_text_in_rows(table: pa.Table, path: Path) -> pa.Table:
    """The table with texts in each row, of which a file may hold a huge one once.

    Raises:
      UsageError: The longest text, put into each row, would exceed MAX_BYTES.
    """
    import pyarrow as pa

    column = table[FAILURE]
    if not pa.types.is_dictionary(column.type):
        return table
    longest = max((len(text or "") for chunk in column.chunks for text in chunk.dictionary.to_pylist()), default=0)
    if longest * len(column) > MAX_BYTES:
        found = f"column {FAILURE} holds {longest} characters"
        raise UsageError(f"{path}: {found}, too many for each of {len(column)} rows")
    return table.set_column(table.column_names.index(FAILURE), FAILURE, column.cast(column.type.value_type))


def _check_columns(table: pa.Table, numbers: Sequence[str], path: Path) -> None:
    """Raise UsageError if a column holds values of another type, or none in some row."""
    import pyarrow as pa

    for name in numbers:
        if not pa.types.is_floating(table[name].type) or not np.isfinite(table[name].to_numpy()).all():
            raise UsageError(f"{path}: column {name} holds values that are not finite numbers")
        _check_size(table[name].to_numpy(), name, path)
    if (table["duration_s"].to_numpy() < 0.0).any():
        raise UsageError(f"{path}: column duration_s holds negative numbers, expected seconds")
    for name in (name for name in PER_EPISODE if name in table.column_names):
        check, expected = PER_EPISODE[name]
        if not getattr(pa.types, check)(table[name].type) or table[name].null_count:
            raise UsageError(f"{path}: column {name} holds {table[name].type}, expected {expected} in every row")
    if WORK in table.column_names:
        if not pa.types.is_floating(table[WORK].type):
            raise UsageError(f"{path}: column {WORK} holds {table[WORK].type}, expected numbers")
        _check_size(table[WORK].to_numpy(), WORK, path)
    _check_ticks(table["episode"].to_numpy(), table["tick"].to_numpy(), path)


def _check_ticks(episodes: NDArray[np.integer], ticks: NDArray[np.integer], path: Path) -> None:
    """Raise UsageError unless the ticks of each episode are 0, 1, 2 …: targets are computed from a row's place."""
    rows = np.arange(len(ticks))
    first = np.append(True, episodes[1:] != episodes[:-1])
    expected = rows - np.maximum.accumulate(np.where(first, rows, 0))
    wrong = np.flatnonzero(ticks != expected)
    if len(wrong):
        where = f"in row {wrong[0]}, of episode {episodes[wrong[0]]}"
        raise UsageError(f"{path}: column tick holds {ticks[wrong[0]]} {where}, expected {expected[wrong[0]]}")


def _check_size(values: NDArray[np.floating], name: str, path: Path) -> None:
    """Raise UsageError if a number is too large for learners, most of which compute in single precision."""
    if (np.abs(values[np.isfinite(values)]) > MAX_QUANTITY).any():
        raise UsageError(f"{path}: column {name} holds numbers beyond {MAX_QUANTITY:g}, expected smaller ones")
