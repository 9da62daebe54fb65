"""Data sets of whole runs, one for each action that the runs may hold: their manifests and parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tailor.executive import domains
from tailor.models.episodes.episodes import Episode, write_part
from tailor.models.episodes.manifest import write_manifest
from tailor.tools.learning.gathering.data_set_spec import DataSetSpec, argument_names
from tailor.tools.learning.gathering.manifests import argument_ranges, check_resumable, context_entry, source_entries
from tailor.tools.lockstep.episode_extraction import data_set_of


def prepare(
    domain: str, folder: Path, names: Sequence[str], about: dict[str, Any], runs: Sequence[Any], resume: bool
) -> None:
    """Create a data set folder with its manifest for each action.

    Raises:
      UsageError: One of them holds other episodes, or the same ones without `resume`; nothing is written then.
    """
    create({folder / action: manifest(domain, folder, action, about, len(runs)) for action in names}, resume)


def manifest(domain: str, folder: Path, action: str, about: dict[str, Any], runs: int) -> dict[str, Any]:
    """The manifest of the episodes of an action in a number of runs; `about` is added to it."""
    loaded = domains.load(domain)
    return {
        "robot": loaded.robot,
        "domain": domain,
        "action": action,
        "arguments": argument_ranges(loaded, DataSetSpec(domain, action, 0, 0, folder)),
        **context_entry(loaded, action, names=()),
        "runs": runs,
        **source_entries(domain),
        "on_policy": True,
        **about,
    }


def create(manifests: Mapping[Path, dict[str, Any]], resume: bool) -> None:
    """Create data set folders with their manifests; see `prepare`."""
    for place, manifest in manifests.items():
        check_resumable(place, manifest, resume)
    for place, manifest in manifests.items():
        place.mkdir(parents=True, exist_ok=True)
        write_manifest(place, manifest)


def modelled_actions(domain: str) -> list[str]:
    """Actions that have a duration model, which are the names of the data sets."""
    return sorted({data_set_of(action) for action in domains.load(domain).actions.values()})


def write(domain: str, folder: Path, part: str, cut: Sequence[tuple[str, Episode]]) -> None:
    """Write the episodes of some runs to the data sets of their actions."""
    loaded = domains.load(domain)
    for action in modelled_actions(domain):
        mine = [episode for name, episode in cut if name == action]
        if mine:
            names = argument_names(loaded, action)
            write_part(folder / action / f"part-{part}.parquet", mine, names)
