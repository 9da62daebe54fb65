"""Changes between two recordings of a scenario: result, durations, models, settings, first different message."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any

from tailor.runtime.recordings.recording import Recorded, open_recording
from tailor.schemas.topics import TOPICS
from tailor.tools.recordings.comparison import ComparedRun, compared_run
from tailor.tools.recordings.differences import first_field
from tailor.tools.recordings.executive_run import PROVENANCE_KEY, decoded
from tailor.tools.recordings.recorded_run import RecordedRuns


def changes(old: Path, new: Path) -> list[str]:
    """One line per change, old value before new; empty if the recordings are equal.

    Raises:
      UsageError: A file cannot be read, e.g. because its message types have changed.
    """
    lines = [*_provenance_changes(_provenance(old), _provenance(new))]
    first = first_change(old, new)
    if first:
        lines += [*_outcome(compared_run(old), compared_run(new)), f"first at  {first}"]
    return lines


def first_change(old: Path, new: Path) -> str:
    """First different message: tick, key, field and both values; empty if there is none."""
    tick = 1
    for before, now in zip_longest(_messages(old), _messages(new)):
        if before is None or now is None or (before.key, before.sequence) != (now.key, now.sequence):
            return f"tick {tick}: was {_name(before)}, now {_name(now)}"
        if before.data != now.data:
            field, then, today = first_field(decoded(before), decoded(now))
            return f"tick {tick}, {now.key}, {field}: was {then}, now {today}"
        tick += now.key == TOPICS["tick"].key
    return ""


def outcome(run: ComparedRun) -> str:
    """Result of a run and durations of its actions."""
    actions = ", ".join(
        f"{a.action} {'' if a.outcome == 'done' else a.outcome + ' '}{a.actual_s:.1f}" for a in run.actions
    )
    return f"{run.result or 'no result'} in {run.total_s:.1f} s: {actions}"


def _outcome(before: ComparedRun, now: ComparedRun) -> Iterator[str]:
    was, is_now = outcome(before), outcome(now)
    if was != is_now:
        yield f"was       {was}"
    yield f"now       {is_now}" + ("" if was != is_now else " (as before)")


def _provenance_changes(before: dict[str, Any], now: dict[str, Any]) -> Iterator[str]:
    """Changed models and settings; the platform and new settings are ignored."""
    names = sorted({*before["models"], *now["models"]})
    models = [name for name in names if before["models"].get(name) != now["models"].get(name)]
    if models:
        yield f"models    changed: {', '.join(models)}"
    then, today = _leaves(before["config"]), _leaves(now["config"])
    for name, value in then.items():
        if today.get(name) != value:
            yield f"settings  {name} was {value}, now {today.get(name, 'removed')}"


def _leaves(settings: Any, name: str = "") -> dict[str, Any]:
    """Settings by their full names, e.g. "settings.refinement.horizon"."""
    if not isinstance(settings, dict):
        return {name: settings}
    inner = (_leaves(value, f"{name}.{key}".strip(".")) for key, value in settings.items())
    return {full: value for part in inner for full, value in part.items()}


def _provenance(path: Path) -> dict[str, Any]:
    return RecordedRuns(path).runs[0].provenance


def _messages(path: Path) -> Iterator[Recorded]:
    return (message for message in open_recording(path).messages() if message.key != PROVENANCE_KEY)


def _name(message: Recorded | None) -> str:
    return "the end" if message is None else f"{message.key} number {message.sequence}"
