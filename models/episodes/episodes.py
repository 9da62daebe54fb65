"""Data sets of episodes: Parquet parts with one row group per episode; the manifest holds their provenance.

A part is written atomically, so that gathering can be killed at any time and resumed later.
"""

from __future__ import annotations

import hashlib
import itertools
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tailor.models.episodes.distinct import check_distinct
from tailor.models.episodes.manifest import read_manifest
from tailor.models.episodes.part_reader import IN_CONTEXT, WORK, parts_of, parts_sha256, read_part
from tailor.models.episodes.sources import CALIBRATES, PROBE, SELECTED, end_of, probe_of, source_files, source_of
from tailor.models.episodes.whole_files import write_whole
from tailor.schemas.errors import UsageError

if TYPE_CHECKING:
    import pyarrow as pa
    import pyarrow.parquet as pq

Array = NDArray[np.float64]
SHORT_EPISODES = 1000  # of a single tick, in one row group
TICK_S = 0.1  # episodes are recorded at 10 Hz (paper 5.1)
UNOBSERVED = "unobserved"  # "failure" of an episode whose success was not observed


@dataclass(frozen=True, slots=True)
class Episode:
    """One execution of an action.

    Attributes:
      number: Number in its data set.
      arguments: Requested current and goal state, shape (k,).
      ticks: Believed current state, and goal state, at each 10 Hz tick, shape (t, k).
      duration_s: Duration in seconds.
      success: Whether the action achieved its effect.
      failure: Kind of failure, `UNOBSERVED`, or empty.
      finished: Whether the controller finished; False if the time limit was exceeded.
      work_j: Work of the drives from each tick to the next in joules, shape (t,); None if not recorded.
      on_policy: Whether an optimiser chose the arguments.
      calibrates: Whether models of duration and energy do not learn from it, which chose it: it corrects intervals.
      in_context: Whether it was decided, or gathered, beside objects of its `ActionContext`, of which the arguments of
        durations know nothing.
      selected: Whether it was selected for what a model did not know: it is learned from, but judges no intervals.
    """

    number: int
    arguments: Array
    ticks: Array
    duration_s: float
    success: bool
    failure: str
    finished: bool = True
    work_j: Array | None = None
    on_policy: bool = False
    in_context: bool = False
    calibrates: bool = False
    selected: bool = False


def write_part(path: Path, episodes: Iterable[Episode], names: Sequence[str]) -> None:
    """Write episodes as one Parquet file, atomically; without episodes nothing is written. See `part_bytes`."""
    store_part(path, part_bytes(episodes, names))


def part_bytes(episodes: Iterable[Episode], names: Sequence[str]) -> bytes:
    """Episodes as the bytes of one Parquet file; empty without episodes.

    Args:
      episodes: One row group each; those of a single tick share one.
      names: Names of the arguments, k.
    """
    import pyarrow as pa  # here, so that commands start without it

    file, writer, tables = BytesIO(), None, []
    for episode in episodes:
        tables.append(_table(episode, names))
        if len(episode.ticks) > 1 or len(tables) == SHORT_EPISODES:
            writer = writer or _writer(file, tables[0])
            writer.write_table(pa.concat_tables(tables))
            tables = []
    if tables:
        writer = writer or _writer(file, tables[0])
        writer.write_table(pa.concat_tables(tables).combine_chunks())
    if writer is not None:
        writer.close()
    return file.getvalue()


def store_part(path: Path, file: bytes) -> None:
    """Write the bytes of a part, atomically; if there are none, nothing is written. See `write_whole`."""
    if file:
        write_whole(path, file)


def _writer(file: BytesIO, table: pa.Table) -> pq.ParquetWriter:
    import pyarrow.parquet as pq

    return pq.ParquetWriter(file, table.schema, compression="zstd", write_page_checksum=True)


def _table(episode: Episode, names: Sequence[str]) -> pa.Table:
    import pyarrow as pa

    count = len(episode.ticks)
    columns: dict[str, Any] = {
        "episode": np.full(count, episode.number, np.int32),
        "tick": np.arange(count, dtype=np.int32),
        **{name: episode.ticks[:, k] for k, name in enumerate(names)},
        **{f"asked_{name}": np.full(count, episode.arguments[k]) for k, name in enumerate(names)},
        WORK: np.full(count, np.nan) if episode.work_j is None else episode.work_j,
        "duration_s": np.full(count, episode.duration_s),
        "success": np.full(count, episode.success),
        "finished": np.full(count, episode.finished),
        "failure": [episode.failure] * count,
        IN_CONTEXT: np.full(count, episode.in_context),
    }
    return pa.table(columns)


@dataclass(frozen=True, slots=True)
class DataSet:
    """Episodes of one action, their manifest, and the SHA-256 of all parts."""

    manifest: Mapping[str, Any]
    episodes: tuple[Episode, ...]
    sha256: str

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the arguments."""
        return tuple(argument["name"] for argument in self.manifest["arguments"])


def read_data_set(folder: Path) -> DataSet:
    """Read all parts of a data set, in order.

    Raises:
      UsageError: The folder holds no data set, or a part cannot be read.
    """
    manifest = read_manifest(folder)
    names = [argument["name"] for argument in manifest["arguments"]]
    episodes: list[Episode] = []
    for path in parts_of(folder):
        episodes.extend(_episodes(read_part(path, names), names, manifest))
    numbers = [episode.number for episode in episodes]
    if len(set(numbers)) < len(numbers):
        repeated = next(number for number, count in Counter(numbers).items() if count > 1)
        raise UsageError(f"{folder}: holds episode {repeated} twice, expected once: training and test would share it")
    return DataSet(manifest, tuple(episodes), parts_sha256(folder))


def merge(sets: Sequence[DataSet]) -> DataSet:
    """Merge data sets of one action; ranges are those of the first, `sources` in the manifest names all.

    Raises:
      UsageError: Robots, actions or arguments differ, or two hold the same episodes, tasks or runs.
    """
    first, *others = sets
    for one, other in itertools.combinations(sets, 2):
        check_distinct(one, other)
    for other in others:
        for key in ("robot", "action"):
            if other.manifest[key] != first.manifest[key]:
                raise UsageError(f"data sets of {key} '{first.manifest[key]}' and '{other.manifest[key]}' do not mix")
        if other.names != first.names:
            raise UsageError(f"data sets with arguments {first.names} and {other.names} do not mix")
    episodes = [replace(e, number=k) for k, e in enumerate(e for each in sets for e in each.episodes)]
    sources = [source_of(each.manifest, len(each.episodes), each.sha256) for each in sets]
    ends = [end_of(episode.duration_s, episode.ticks) for episode in first.episodes if episode.number < PROBE]
    about = {
        "on_policy": sum(source["on_policy"] for source in sources),
        CALIBRATES: sum(source["episodes"] for source in sources if source.get(CALIBRATES)),
        "sources": sources,
        "source_files": source_files([each.manifest for each in sets]),
        "probe": probe_of(first.manifest, ends),
    }
    digest = hashlib.sha256("".join(each.sha256 for each in sets).encode()).hexdigest() if others else first.sha256
    return DataSet({**first.manifest, **about}, tuple(episodes), digest)


def _episodes(table: pa.Table, names: Sequence[str], manifest: Mapping[str, Any]) -> list[Episode]:
    on_policy, calibrates = bool(manifest.get("on_policy")), bool(manifest.get(CALIBRATES))
    selected = any(manifest.get(key) for key in SELECTED)
    column = {name: table[name].to_numpy() for name in table.column_names if name != "failure"}
    failure = table["failure"].to_pylist()
    ticks = np.column_stack([column[name] for name in names])
    requested = np.column_stack([column[f"asked_{name}"] for name in names])
    numbers = column["episode"]
    work = column.get(WORK, np.full(len(numbers), np.nan))  # older data sets lack the columns
    in_context = column.get(IN_CONTEXT, np.zeros(len(numbers), bool))
    starts = np.flatnonzero(np.append(True, numbers[1:] != numbers[:-1]))
    return [
        Episode(
            int(numbers[a]),
            requested[a],
            ticks[a:b],
            float(column["duration_s"][a]),
            bool(column["success"][a]),
            failure[a],
            bool(column["finished"][a]),
            work[a:b] if np.isfinite(work[a:b]).all() else None,
            on_policy,
            bool(in_context[a]),
            calibrates,
            selected,
        )
        for a, b in zip(starts, [*starts[1:], len(numbers)], strict=True)
    ]
