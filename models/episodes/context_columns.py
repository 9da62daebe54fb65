"""Data sets of actions with a context: one object per episode, whose row follows the arguments as further columns.

One data set teaches two kinds of models: those of the action by itself, and its success beside one object.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from tailor.models.episodes.episodes import DataSet, Episode

CONTEXT = "context"  # entry of a manifest: names of the further columns, and the failure that the object causes


def without_context(data: DataSet) -> DataSet:
    """The data set of the action by itself: no further columns, and no episodes that failed by the object."""
    names, failure = _declared(data)
    if not failure:
        return data
    manifest = {key: value for key, value in data.manifest.items() if key != CONTEXT}
    manifest["arguments"] = [argument for argument in manifest["arguments"] if argument["name"] not in names]
    width = len(manifest["arguments"])
    kept = _kept(data, lambda episode: episode.failure != failure)
    cut = (replace(e, arguments=e.arguments[:width], ticks=e.ticks[:, :width]) for e in kept)
    return DataSet(manifest, tuple(cut), data.sha256)


def beside_context(data: DataSet) -> DataSet | None:
    """The data set of success beside one object: only the object's failure; None without such columns."""
    names, failure = _declared(data)
    if not names:
        return None
    return DataSet(data.manifest, _kept(data, lambda episode: episode.failure in ("", failure)), data.sha256)


def run_numbers(sets: Sequence[DataSet]) -> list[int]:
    """Number of the run of each episode of all sets, in order; runs are counted from 0 through all sets.

    A run gives as many episodes as the manifest of its set has `objects`: one, if it has no such entry.
    """
    runs = [
        (which, episode.number // data.manifest.get("objects", 1))
        for which, data in enumerate(sets)
        for episode in data.episodes
    ]
    number = {run: k for k, run in enumerate(sorted(set(runs)))}
    return [number[run] for run in runs]


def _declared(data: DataSet) -> tuple[tuple[str, ...], str]:
    """Names of the further columns, and the object's failure; empty if the action has no context."""
    context = data.manifest.get(CONTEXT) or {}
    return tuple(context.get("names", ())), str(context.get("failure", ""))


def _kept(data: DataSet, belongs: Callable[[Episode], bool]) -> tuple[Episode, ...]:
    return tuple(episode for episode in data.episodes if belongs(episode))
