"""Sources of the episodes of a model: one entry for each data set that was merged, as its card holds them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Manifest = Mapping[str, Any]

# entries of a manifest that determine the episodes, with "source": random, on-policy, active, uncertain, recordings
# and of choices by models what chose: `models_sha256`, and `runs_sha256` of the executive's source
CHOSEN_BY = ("models_sha256", "runs_sha256")
CANDIDATES = "candidates"  # number of tasks among which those of uncertain success were selected
DRAW = (
    "source", "seed", "stream", "scenarios", "horizon", "situations", CANDIDATES, "recordings", *CHOSEN_BY, "profile",
)  # fmt: skip
SELECTED = ("situations", CANDIDATES)  # entries of a manifest whose episodes were selected among so many
PROBE = 6  # first episodes of a data set that a card repeats, to be run again where the source has changed
CALIBRATES = "calibrates"  # entry of a manifest: its episodes correct the intervals of the models that chose them
BESIDE_ONE = " beside one object"  # end of the "source" of random episodes
RUN_NUMBERS = 100  # from the number of a run's first episode to that of the next run's
SHORT = 12  # digits of a hash of a file in a card


def source_of(manifest: Manifest, count: int, sha256: str) -> dict[str, Any]:
    """Entry of one data set: robot, action, how its episodes were drawn, their number and hash, and its source.

    Args:
      manifest: Of the data set.
      count: Number of its episodes.
      sha256: Of its episodes.
    """
    return {
        **{key: manifest.get(key) for key in ("robot", "action")},
        **{key: manifest[key] for key in DRAW if key in manifest},
        "episodes": count,
        "on_policy": count if manifest.get("on_policy") else 0,
        **({CALIBRATES: True} if manifest.get(CALIBRATES) else {}),
        "sha256": sha256,
        "source_sha256": manifest.get("source_sha256"),
    }


def source_files(manifests: Sequence[Manifest]) -> dict[str, Mapping[str, str]]:
    """Hashes by file of every source that episodes were simulated with, by `source_sha256`."""
    return {m["source_sha256"]: m["source_files"] for m in manifests if m.get("source_sha256") and "source_files" in m}


def short_hashes(files: Mapping[str, str]) -> dict[str, str]:
    """Hashes by file, as short as cards hold them."""
    return {name: sha256[:SHORT] for name, sha256 in files.items()}


def probe_of(manifest: Manifest, ends: Sequence[Sequence[float]]) -> dict[str, Any] | None:
    """How the first PROBE episodes of a data set with random arguments ended; None for other data sets."""
    drawn = manifest.get("seed") is not None and manifest.get("stream") is not None
    beside = bool((manifest.get("context") or {}).get("names"))
    if "beside" in str(manifest.get("source")) and not beside:
        return None  # the object that the episodes were run beside is not among their columns
    if not drawn or len(ends) < PROBE or manifest.get("on_policy"):
        return None
    about = {"seed": manifest["seed"], "stream": manifest["stream"], "ends": list(map(list, ends))}
    more = {key: manifest[key] for key in ("objects", "profile") if manifest.get(key)}
    return about | ({"beside": True} if beside else {}) | more


def end_of(duration_s: float, ticks: NDArray[np.float64]) -> list[float]:
    """Duration of an episode in seconds, and the arguments with the believed state at its last tick."""
    return [round(float(value), 6) for value in (duration_s, *ticks[-1])]
