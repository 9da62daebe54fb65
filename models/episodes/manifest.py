"""Manifest of a data set: a JSON file beside its parts with robot, action, arguments and provenance."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tailor.models.cards.json_shape import arguments_error
from tailor.schemas.errors import UsageError

MANIFEST = "manifest.json"


def write_manifest(folder: Path, manifest: Mapping[str, Any]) -> None:
    """Write the manifest of a data set atomically."""
    temporary = folder / f".{MANIFEST}.{os.getpid()}"
    temporary.write_text(json.dumps(manifest, indent=1) + "\n")
    temporary.replace(folder / MANIFEST)


def read_manifest(folder: Path) -> dict[str, Any]:
    """Read the manifest of a data set.

    Raises:
      UsageError: The file is missing, or is not a manifest.
    """
    try:
        manifest = json.loads((folder / MANIFEST).read_text())
    except OSError:
        raise UsageError(f"{folder}: no {MANIFEST}, expected a data set (`tailor gather` writes them)") from None
    except ValueError as error:
        raise UsageError(f"{folder / MANIFEST}: not a manifest ({error}), `tailor gather` writes them") from None
    problem = _manifest_error(manifest)
    if problem:
        raise UsageError(f"{folder / MANIFEST}: not a manifest ({problem}), `tailor gather` writes them")
    return dict(manifest)


def _manifest_error(manifest: Any) -> str:
    """First error in the entries that training needs; empty if there is none."""
    if not isinstance(manifest, dict):
        return f"a {type(manifest).__name__}, expected an object"
    for key in ("robot", "action"):
        if not isinstance(manifest.get(key), str):
            return f"{key} is {manifest.get(key)!r}, expected a name"
    return arguments_error(manifest.get("arguments"))
