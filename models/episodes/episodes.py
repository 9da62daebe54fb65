"""Data sets of episodes: Parquet parts with one row group per episode; manifest.py says how they were made.

A part appears whole or not at all, so that gathering may be killed at any time and go on later.
"""

from __future__ import annotations

import hashlib
import itertools
import os
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from tailor.models.episodes.manifest import read_manifest
from tailor.schemas.errors import UsageError

Array = NDArray[np.float64]
TICK_S = 0.1  # episodes are recorded at 10 Hz (paper 5.1)
WHOLE = ("episode", "success", "finished", "failure")  # columns of a part beside the numbers to learn from
UNOBSERVED = "unobserved"  # "failure" of an episode that says nothing about success


@dataclass(frozen=True, slots=True)
class Episode:
    """One run of an action: what was asked, what was seen at each tick, and how it ended."""

    number: int
    arguments: Array  # (k,) as asked for: current and goal state
    ticks: Array  # (t, k) the same at each 10 Hz tick: the believed current state and the goal
    duration_s: float
    success: bool
    failure: str  # kind of failure, empty if none
    finished: bool = True  # the controller said so; False: the time limit did
    work_j: Array | None = None  # (t,) joules of the drives from each tick to the next; None: nobody knows
    on_policy: bool = False  # an optimiser chose its arguments


def write_part(path: Path, episodes: Iterable[Episode], names: Sequence[str]) -> None:
    """Write episodes as one Parquet file, a row group each; `names` are those of the arguments."""
    temporary = path.with_suffix(f".{os.getpid()}.tmp")
    writer = None
    try:
        for episode in episodes:
            table = _table(episode, names)
            writer = writer or pq.ParquetWriter(temporary, table.schema, compression="zstd", write_page_checksum=True)
            writer.write_table(table)
    finally:
        if writer is not None:
            writer.close()
    if writer is not None:
        temporary.replace(path)


def _table(episode: Episode, names: Sequence[str]) -> pa.Table:
    count = len(episode.ticks)
    columns: dict[str, Any] = {
        "episode": np.full(count, episode.number, np.int32),
        "tick": np.arange(count, dtype=np.int32),
        **{name: episode.ticks[:, k] for k, name in enumerate(names)},
        **{f"asked_{name}": np.full(count, episode.arguments[k]) for k, name in enumerate(names)},
        "work_j": np.full(count, np.nan) if episode.work_j is None else episode.work_j,
        "duration_s": np.full(count, episode.duration_s),
        "success": np.full(count, episode.success),
        "finished": np.full(count, episode.finished),
        "failure": [episode.failure] * count,
    }
    return pa.table(columns)


@dataclass(frozen=True, slots=True)
class DataSet:
    """Episodes of one action with their manifest and a hash of all parts."""

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
    digest = hashlib.sha256()
    for path in sorted(folder.glob("part-*.parquet")):
        digest.update(path.read_bytes())
        episodes.extend(_episodes(_read_part(path, names), names, bool(manifest.get("on_policy"))))
    numbers = [episode.number for episode in episodes]
    if len(set(numbers)) < len(numbers):
        twice = next(number for number, count in Counter(numbers).items() if count > 1)
        raise UsageError(f"{folder}: holds episode {twice} twice, expected each once: tests must be of unseen ones")
    return DataSet(manifest, tuple(episodes), digest.hexdigest())


def _read_part(path: Path, names: Sequence[str]) -> pa.Table:
    """A part with all that it must hold.

    Raises:
      UsageError: It cannot be read, is damaged, lacks a column, or holds what is no number.
    """
    try:
        table = pq.read_table(path, page_checksum_verification=True)
    except (pa.ArrowException, OSError) as error:
        raise UsageError(f"{path}: cannot be read ({error}), expected a part of a data set") from None
    numbers = [*names, *(f"asked_{name}" for name in names), "duration_s"]
    missing = [name for name in (*WHOLE, *numbers) if name not in table.column_names]
    if missing or not table.num_rows:
        raise UsageError(f"{path}: lacks {', '.join(missing) or 'rows'}, expected a part of a data set")
    for name in numbers:
        if not pa.types.is_floating(table[name].type) or not np.isfinite(table[name].to_numpy()).all():
            raise UsageError(f"{path}: column {name} holds what is no finite number, expected some everywhere")
    return table


def merge(sets: Sequence[DataSet]) -> DataSet:
    """Several data sets of one action as one; the first one's manifest speaks, its ranges stand.

    Raises:
      UsageError: They are of different robots, actions or arguments, or two hold the same episodes.
    """
    first, *others = sets
    for one, other in itertools.combinations(sets, 2):
        if one.sha256 == other.sha256 or _drawn(one.manifest) == _drawn(other.manifest) is not None:
            action, seed = one.manifest["action"], one.manifest.get("seed")
            raise UsageError(f"two data sets hold the same episodes of {action} (seed {seed}), expected each once")
    for other in others:
        for key in ("robot", "action"):
            if other.manifest[key] != first.manifest[key]:
                raise UsageError(f"data sets of {key} '{first.manifest[key]}' and '{other.manifest[key]}' do not mix")
        if other.names != first.names:
            raise UsageError(f"data sets with arguments {first.names} and {other.names} do not mix")
    episodes = [replace(e, number=k) for k, e in enumerate(e for each in sets for e in each.episodes)]
    policy = sum(len(each.episodes) for each in sets if each.manifest.get("on_policy"))
    digest = hashlib.sha256("".join(each.sha256 for each in sets).encode()).hexdigest() if others else first.sha256
    return DataSet({**first.manifest, "on_policy": policy}, tuple(episodes), digest)


def _drawn(manifest: Mapping[str, Any]) -> list[Any] | None:
    """What decided which episodes a data set holds; None where no seed did."""
    if manifest.get("seed") is None:
        return None
    return [manifest.get(key) for key in ("seed", "stream", "source", "scenarios", "models_sha256")]


def _episodes(table: pa.Table, names: Sequence[str], on_policy: bool) -> list[Episode]:
    column = {name: table[name].to_numpy() for name in table.column_names if name != "failure"}
    failure = table["failure"].to_pylist()
    ticks = np.column_stack([column[name] for name in names])
    asked = np.column_stack([column[f"asked_{name}"] for name in names])
    numbers = column["episode"]
    work = column.get("work_j", np.full(len(numbers), np.nan))  # older data sets do not tell
    starts = np.flatnonzero(np.diff(numbers, prepend=numbers[0] - 1))
    return [
        Episode(
            int(numbers[a]),
            asked[a],
            ticks[a:b],
            float(column["duration_s"][a]),
            bool(column["success"][a]),
            failure[a],
            bool(column["finished"][a]),
            work[a:b] if np.isfinite(work[a:b]).all() else None,
            on_policy,
        )
        for a, b in zip(starts, [*starts[1:], len(numbers)], strict=True)
    ]
