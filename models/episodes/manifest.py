"""Manifest of a data set: a JSON file beside its parts with robot, action, arguments and provenance."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tailor.models.cards.episodes_shape import are_hashes
from tailor.models.cards.json_shape import arguments_error, is_count
from tailor.models.episodes.whole_files import write_whole
from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import read_json, shown

MANIFEST = "manifest.json"
# Part of the paths of models: "../x" would be written beside the zoo. Actions have capitals, unlike a spec's NAME.
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


def _are_names(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(each, str) for each in value)


def _is_context(value: Any) -> bool:
    return isinstance(value, dict) and _are_names(value.get("names", [])) and isinstance(value.get("failure", ""), str)


def _context_error(manifest: Mapping[str, Any]) -> str:
    """Error in how a manifest's context fits its arguments, which have a shape; empty if there is none.

    Training takes the last columns for those of an object, and its failure for the only one that objects cause.
    """
    context = manifest.get("context") or {}
    names, declared = context.get("names", []), [argument["name"] for argument in manifest["arguments"]]
    if names and (not context.get("failure") or declared[-len(names) :] != names or declared == names):
        return f"context is {shown(context)}, expected the names of the last arguments, and a failure"
    if manifest.get("objects") and not names:
        return f"objects is {manifest['objects']}, expected none without names in `context`"
    return ""


def _is_of_all(value: Any) -> bool:
    """Random data sets hold 0 for false. A count of some of the episodes would pass for all of them."""
    return isinstance(value, bool) or (is_count(value) and value == 0)


OPTIONAL: Mapping[str, tuple[Callable[[Any], bool], str]] = {  # entries that resuming and training compute with
    "episodes": (is_count, "a whole number"),
    "runs": (is_count, "a whole number"),
    "objects": (lambda value: is_count(value) and value > 0, "a whole number, at least 1"),
    "scenarios": (_are_names, "a list of names"),
    "horizon": (lambda value: is_count(value) and value > 0, "a whole number, at least 1"),
    "situations": (is_count, "a whole number"),
    "candidates": (is_count, "a whole number"),
    "profile": (lambda value: isinstance(value, str), "text"),
    "recordings": (_are_names, "a list of names"),
    "context": (_is_context, "names of columns, and a failure"),
    "seed": (is_count, "a whole number"),
    "stream": (is_count, "a whole number"),
    "calibrates": (lambda value: isinstance(value, bool), "true or false"),
    "on_policy": (_is_of_all, "true or false, or 0 for false"),
    "source_sha256": (lambda value: isinstance(value, str), "text"),
    "source_files": (are_hashes, "an object of hashes by file"),
}


def write_manifest(folder: Path, manifest: Mapping[str, Any]) -> None:
    """Write the manifest of a data set atomically. Raises UsageError, as on a full disk."""
    write_whole(folder / MANIFEST, (json.dumps(manifest, indent=1) + "\n").encode())


def read_manifest(folder: Path) -> dict[str, Any]:
    """Read the manifest of a data set.

    Raises:
      UsageError: The file is missing, cannot be read, or is not a manifest.
    """
    if not (folder / MANIFEST).is_file():  # a named pipe would be waited for
        raise UsageError(f"{folder}: no {MANIFEST}, expected a data set (`tailor gather` writes them)")
    manifest = read_json(folder / MANIFEST, "a manifest (`tailor gather` writes them)")
    problem = _manifest_error(manifest)
    if problem:
        raise UsageError(f"{folder / MANIFEST}: not a manifest ({problem}), `tailor gather` writes them")
    return dict(manifest)


def _manifest_error(manifest: Any) -> str:
    """First error in the entries that resuming and training need; empty if there is none."""
    if not isinstance(manifest, dict):
        return f"a {type(manifest).__name__}, expected an object"
    for key in ("robot", "action"):
        if not (isinstance(manifest.get(key), str) and _NAME.fullmatch(manifest[key])):
            return f"{key} is {shown(manifest.get(key))}, expected a letter, then letters, digits, - and _"
    for key, (has_shape, expected) in OPTIONAL.items():
        if manifest.get(key) is not None and not has_shape(manifest[key]):
            return f"{key} is {shown(manifest[key])}, expected {expected}"
    return arguments_error(manifest.get("arguments")) or _context_error(manifest)
