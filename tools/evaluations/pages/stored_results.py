"""Results of evaluations that earlier calls stored beside their pages; a damaged file counts as a missing one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import read_json


def stored_result(folder: Path, name: str) -> dict[str, Any] | None:
    """The result of an evaluation: title, rows, and provenance, which older ones lack.

    Args:
      folder: Of the pages.
      name: Of the evaluation.

    Returns:
      None unless the folder holds its complete page, with a result that can be read.
    """
    found = read_object(folder / f"{name}.json")
    rows = found.get("rows")
    is_whole = isinstance(found.get("title"), str) and isinstance(found.setdefault("provenance", {}), dict)
    if not is_whole or not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        return None
    return found if (folder / f"{name}.html").exists() else None


def read_object(file: Path) -> dict[str, Any]:
    """The JSON object in a file; an empty one if there is none that can be read."""
    try:
        found = read_json(file, "an object")
    except UsageError:
        return {}
    return found if isinstance(found, dict) else {}
