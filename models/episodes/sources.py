"""Sources of the episodes of a model: one entry for each data set that was merged, as its card holds them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray


class SomeEpisode(Protocol):
    """What is needed of an Episode."""

    @property
    def number(self) -> int: ...
    @property
    def duration_s(self) -> float: ...
    @property
    def ticks(self) -> NDArray[np.float64]: ...


class SomeData(Protocol):
    """What is needed of a DataSet."""

    @property
    def manifest(self) -> Mapping[str, Any]: ...
    @property
    def episodes(self) -> Sequence[SomeEpisode]: ...
    @property
    def sha256(self) -> str: ...


# entries of a manifest that determine the episodes, with "source": random, on-policy, active, recordings
DRAW = ("source", "seed", "stream", "scenarios", "situations", "recordings", "models_sha256")
PROBE = 6  # first episodes of a data set that a card repeats, to be run again where the source has changed
SHORT = 12  # digits of a hash of a file in a card


def source_of(data: SomeData) -> dict[str, Any]:
    """Entry of one data set: robot, action, how its episodes were drawn, their number and hash, and its source."""
    manifest, count = data.manifest, len(data.episodes)
    return {
        **{key: manifest.get(key) for key in ("robot", "action")},
        **{key: manifest[key] for key in DRAW if key in manifest},
        "episodes": count,
        "on_policy": count if manifest.get("on_policy") else 0,
        "sha256": data.sha256,
        "source_sha256": manifest.get("source_sha256"),
    }


def source_files(sets: Sequence[SomeData]) -> dict[str, Mapping[str, str]]:
    """Hashes by file of every source that episodes were simulated with, by `source_sha256`."""
    manifests = [data.manifest for data in sets]
    return {m["source_sha256"]: m["source_files"] for m in manifests if m.get("source_sha256") and "source_files" in m}


def short_hashes(files: Mapping[str, str]) -> dict[str, str]:
    """Hashes by file, as short as cards hold them."""
    return {name: sha256[:SHORT] for name, sha256 in files.items()}


def probe_of(data: SomeData) -> dict[str, Any] | None:
    """How the first episodes of a data set with random arguments ended; None for other data sets."""
    drawn = data.manifest.get("seed") is not None and data.manifest.get("stream") is not None
    first = [episode for episode in data.episodes if episode.number < PROBE]
    if not drawn or len(first) < PROBE or data.manifest.get("on_policy"):
        return None
    return {"seed": data.manifest["seed"], "stream": data.manifest["stream"], "ends": [end_of(each) for each in first]}


def end_of(episode: SomeEpisode) -> list[float]:
    """Duration in seconds, and the arguments with the believed state at the last tick."""
    return [round(float(value), 6) for value in (episode.duration_s, *episode.ticks[-1])]
