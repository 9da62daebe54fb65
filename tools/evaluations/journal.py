"""Finished runs on disk, from which an interrupted evaluation resumes."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from pathlib import Path

from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.parsed_files import table_of
from tailor.schemas.settings import from_table
from tailor.tools.evaluations.outcome import Outcome, Task, Variant


class Journal:
    """Finished runs of one variant, one line of JSON each. The file name contains a hash of all that they depend on.

    Args:
      folder: Of all journals; None stores nothing.
      task: Scenario of the runs.
      variant: Settings of the runs.
      dependencies: Hashes of models and source code.

    Attributes:
      known: Stored outcomes by seed.
    """

    def __init__(self, folder: Path | None, task: Task, variant: Variant, dependencies: list[str]) -> None:
        self.known: dict[int, Outcome] = {}
        self._path: Path | None = None
        if folder is None:
            return
        key = json.dumps([dataclasses.asdict(task), dataclasses.asdict(variant), dependencies], sort_keys=True)
        name = f"{task.domain}-{task.scenario}-{variant.name}-{hashlib.sha256(key.encode()).hexdigest()[:12]}.jsonl"
        folder.mkdir(parents=True, exist_ok=True)
        self._path = folder / name
        if self._path.exists():
            text = self._path.read_text(errors="replace")
            if text and not text.endswith("\n"):
                self._write("\n")  # ends a truncated line
            for line in text.splitlines():
                outcome = _read(line)
                if outcome is not None:
                    self.known[outcome.seed] = outcome

    def note(self, outcome: Outcome) -> None:
        """Store an outcome."""
        self._write(json.dumps(dataclasses.asdict(outcome)) + "\n")

    def _write(self, text: str) -> None:
        """Append to the file: what is in it stays, also if the disk is full or another command writes there, too.

        Raises:
          UsageError: It cannot be written; the error of a full disk names no file.
        """
        if self._path is None:
            return
        try:
            with self._path.open("a") as file:
                file.write(text)
        except OSError as error:
            expected = "expected a file that can be written; finished runs are kept"
            raise UsageError(f"{self._path}: {error.strerror}, {expected}") from None


def _read(line: str) -> Outcome | None:
    """The outcome of a line; None for a truncated or damaged line, whose run is repeated."""
    fields = table_of(line)
    if isinstance(fields, Rejected):
        return None
    try:
        return from_table(Outcome, fields, "")
    except UsageError:
        return None
