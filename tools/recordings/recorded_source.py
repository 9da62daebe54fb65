"""Whether a recording was made by today's source, for the reader of a difference."""

from __future__ import annotations

from typing import Any

from tailor import __version__
from tailor.tools.cli.plain_text import plain

UNSTATED = "which source recorded it is unknown: recordings of before 2026-11-26, and golden ones, do not state it"


def source_entry(folders: dict[str, str]) -> dict[str, Any]:
    """Entry `source` of a provenance; `folders` as tailor.schemas.installed.core_source has them."""
    return {"version": __version__, "folders": folders}


def source_contrast(recorded: Any, today: dict[str, str], same_kind: bool) -> str:
    """What lies between the source of a recording and today's, in a line.

    Args:
      recorded: Entry `source` of its provenance, from a file; None or anything else: unknown.
      today: Hashes of today's folders.
      same_kind: Whether the recording platform computes as this one does.
    """
    folders = recorded.get("folders") if isinstance(recorded, dict) else None
    if not isinstance(folders, dict):
        return UNSTATED
    other = [name for name in sorted({*folders, *today}, key=str) if folders.get(name) != today.get(name)]
    if not other and not same_kind:
        return "recorded by this very source, on a platform that rounds otherwise: a choice between equals may differ"
    if not other:
        return "recorded by this very source: equal inputs gave other outputs, which is a fault"
    version, folders_shown = str(recorded.get("version")), ", ".join(map(str, other))
    return f"recorded by tailor {_short(version, 20)} with another {_short(folders_shown, 200)}"


def _short(text: str, most: int) -> str:
    """At most so many characters of a text from a file, for a terminal."""
    return plain(text[:most])[:most]
