"""Checks of what a card states about its episodes: whether a model is stale is decided by it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tailor.models.cards.json_shape import is_count, is_number
from tailor.schemas.parsed_files import shown

MAX_OBJECTS = 10_000  # noted after each run: memory holds all episodes of some runs


def episodes_error(episodes: Mapping[str, Any]) -> str:
    """First error in the entry `episodes` of a card; empty if there is none."""
    if not is_number(episodes.get("count")):
        return f"episodes' count is {shown(episodes.get('count'))}, expected a number"
    sources, files, probe = episodes.get("sources", []), episodes.get("source_files", {}), episodes.get("probe")
    if not isinstance(sources, list) or not all(map(_is_source, sources)):
        return f"episodes' sources are {shown(sources)}, expected objects with the text source_sha256"
    if not isinstance(files, dict) or not all(map(are_hashes, files.values())):
        return f"episodes' source_files are {shown(files)}, expected hashes by file"
    if probe is not None and not _is_probe(probe):
        return f"episodes' probe is {shown(probe)}, expected seed, stream and the numbers of some ends"
    return ""


def _is_source(value: Any) -> bool:
    return isinstance(value, dict) and isinstance(value.get("source_sha256") or "", str)


def are_hashes(value: Any) -> bool:
    """Whether a value is an object of texts: hashes by file."""
    return isinstance(value, dict) and all(isinstance(each, str) for each in value.values())


def _is_probe(value: Any) -> bool:
    counts = ("seed", "stream", "objects")
    if not isinstance(value, dict) or not all(is_count(value.get(key, 0)) for key in counts):
        return False
    if value.get("objects", 0) > MAX_OBJECTS or not isinstance(value.get("profile", ""), str):
        return False
    ends = value.get("ends")
    return {"seed", "stream"} <= set(value) and isinstance(ends, list) and all(map(_are_numbers, ends))


def _are_numbers(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(map(is_number, value))
