"""Finished episodes on disk, so that an evaluation that was broken off goes on where it stopped."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from pathlib import Path
from typing import Any

from tailor.tools.evaluations.outcome import Outcome, Task, Variant


class Journal:
    """The finished episodes of one variant, a line of JSON each, in a file named by what they depend on."""

    def __init__(self, folder: Path | None, task: Task, variant: Variant, models: list[str]) -> None:
        self.known: dict[int, Outcome] = {}
        self._path: Path | None = None
        if folder is None:
            return
        said = json.dumps([dataclasses.asdict(task), dataclasses.asdict(variant), models], sort_keys=True)
        name = f"{task.domain}-{task.scenario}-{variant.name}-{hashlib.sha256(said.encode()).hexdigest()[:12]}.jsonl"
        folder.mkdir(parents=True, exist_ok=True)
        self._path = folder / name
        if self._path.exists():
            text = self._path.read_text(errors="replace")
            if text and not text.endswith("\n"):
                self._path.write_text(text + "\n")  # a line was cut off; the next one shall not hang on to it
            for line in text.splitlines():
                outcome = _read(line)
                if outcome is not None:
                    self.known[outcome.seed] = outcome

    def note(self, outcome: Outcome) -> None:
        """Keep an outcome."""
        if self._path is not None:
            with self._path.open("a") as file:
                file.write(json.dumps(dataclasses.asdict(outcome)) + "\n")


def _read(line: str) -> Outcome | None:
    """An outcome from its line; None for a line that was cut off or damaged: its episode is run again."""
    try:
        return Outcome(**{key: _frozen(value) for key, value in json.loads(line).items()})
    except (ValueError, TypeError, AttributeError):
        return None


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value
