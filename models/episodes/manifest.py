"""The manifest of a data set: a JSON file beside its parts that says whose episodes they are and how they were made."""

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
    """Write the manifest of a data set, whole or not at all."""
    temporary = folder / f".{MANIFEST}.{os.getpid()}"
    temporary.write_text(json.dumps(manifest, indent=1) + "\n")
    temporary.replace(folder / MANIFEST)


def read_manifest(folder: Path) -> dict[str, Any]:
    """The manifest of a data set.

    Raises:
      UsageError: There is none, or it is not one.
    """
    try:
        manifest = json.loads((folder / MANIFEST).read_text())
    except OSError:
        raise UsageError(f"{folder}: no {MANIFEST}, expected a data set (`tailor gather` makes them)") from None
    except ValueError as error:
        raise UsageError(f"{folder / MANIFEST}: not a manifest ({error}), `tailor gather` writes them") from None
    wrong = _manifest_error(manifest)
    if wrong:
        raise UsageError(f"{folder / MANIFEST}: not a manifest ({wrong}), `tailor gather` writes them")
    return dict(manifest)


def _manifest_error(manifest: Any) -> str:
    """What is wrong with it; empty if nothing that training needs."""
    if not isinstance(manifest, dict):
        return f"a {type(manifest).__name__}, expected an object"
    for key in ("robot", "action"):
        if not isinstance(manifest.get(key), str):
            return f"{key} is {manifest.get(key)!r}, expected a name"
    return arguments_error(manifest.get("arguments"))
