"""Finished evaluations beside their pages: the flags of each and its exit code, so that a resumed call skips it."""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tailor.tools.cli.output_files import whole_output
from tailor.tools.evaluations.pages.stored_results import read_object, stored_result

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
    """Exit code of an evaluation whose page is there; None unless all can be read, and flags, source and models equal.

    Args:
      folder: Of the pages.
      name: Of the evaluation.
      flags: Those of now; see `flags_of`.
      provenance: Hashes of the source and the models of now, which count as far as the page states any.
    """
    result, noted = stored_result(folder, name), read_object(_file(folder, name))
    code = noted.get("exit_code")
    if result is None or not isinstance(code, int):
        return None
    stated = {key: str(result["provenance"].get(key, "")) for key in HASHES}
    same = all(stated[key] == provenance[key] for key in HASHES if SHA256.fullmatch(stated[key]))
    return code if same and noted.get("flags") == flags else None


def _file(folder: Path, name: str) -> Path:
    return folder / f".{name}.finished.json"
