"""Finished evaluations beside their pages: the flags of each and its exit code, so that a resumed call skips it."""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tailor.tools.cli.output_files import whole_output
from tailor.tools.evaluations.pages.overview import page_is_there

HASHES, SHA256 = ("source_sha256", "models_sha256"), re.compile("[0-9a-f]{64}")
WITHOUT_EFFECT = ("jobs", "on", "json", "report", "store")  # flags that change no figure


def flags_of(settings: argparse.Namespace) -> dict[str, Any]:
    """The flags of an evaluation that its figures depend on, as JSON values."""
    kept = {key: value for key, value in vars(settings).items() if key not in WITHOUT_EFFECT}
    read: dict[str, Any] = json.loads(json.dumps(kept, default=str))
    return read


def note(folder: Path, name: str, flags: Mapping[str, Any], exit_code: int) -> None:
    """Note that an evaluation's page is complete; see `exit_code_of`."""
    with whole_output(_file(folder, name)) as whole:
        whole.write_text(json.dumps({"flags": flags, "exit_code": exit_code}) + "\n", encoding="utf-8")


def forget(folder: Path, name: str) -> None:
    """Remove the note of an evaluation that is about to run again."""
    _file(folder, name).unlink(missing_ok=True)


def exit_code_of(folder: Path, name: str, flags: Mapping[str, Any], provenance: Mapping[str, Any]) -> int | None:
    """Exit code of an evaluation whose page is there; None unless flags, source and models are the same.

    Args:
      folder: Of the pages.
      name: Of the evaluation.
      flags: Those of now; see `flags_of`.
      provenance: Hashes of the source and the models of now, which count as far as the page states any.
    """
    if not page_is_there(folder, name) or not _file(folder, name).exists():
        return None
    stated = json.loads((folder / f"{name}.json").read_text("utf-8")).get("provenance", {})
    noted = json.loads(_file(folder, name).read_text("utf-8"))
    same = all(stated[key] == provenance[key] for key in HASHES if SHA256.fullmatch(stated.get(key, "")))
    return int(noted["exit_code"]) if same and noted["flags"] == flags else None


def _file(folder: Path, name: str) -> Path:
    return folder / f".{name}.finished.json"
