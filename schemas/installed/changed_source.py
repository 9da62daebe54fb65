"""Compares the source that a model's episodes were simulated with, as its card states it, with today's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

SIMULATED = "lock-step"  # beginning of the source of episodes that were not recorded from a robot


def changed_files(episodes: Mapping[str, Any], today: Mapping[str, str]) -> list[str]:
    """Files that differ between the sources of simulated episodes and today's.

    Args:
      episodes: Entry `episodes` of a card; without `source_files` nothing is known, and no file differs.
      today: Hashes of today's files, see `episode_files`.
    """
    simulated = [each for each in episodes.get("sources", ()) if str(each.get("source", "")).startswith(SIMULATED)]
    stated = {each.get("source_sha256") for each in simulated} & set(episodes.get("source_files", {}))
    return sorted({name for sha256 in stated for name in differing_files(episodes["source_files"][sha256], today)})


def differing_files(stated: Mapping[str, str], today: Mapping[str, str]) -> set[str]:
    """Files that were added, removed or changed; stated hashes are beginnings of hashes."""
    return {
        name
        for name in stated.keys() | today.keys()
        if name not in stated or not today.get(name, "").startswith(stated[name])
    }
