"""What two recordings of the same scenario say differently: outcome, duration, actions, models, and where it begins."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any

from tailor.runtime.recordings.recording import Recorded, open_recording
from tailor.schemas.topics import TOPICS
from tailor.tools.recordings.comparison import ComparedRun, compared_run
from tailor.tools.recordings.differences import first_field
from tailor.tools.recordings.recorded_run import PROVENANCE_KEY, RecordedRuns, decoded

MESSAGE = Recorded | None


def changes(old: Path, new: Path) -> list[str]:
    """One line a change, what was before what is now; none if a new recording would only be another copy.

    Raises:
      UsageError: One of the files cannot be read; its message types have changed since, for example.
    """
    lines = [*_made_of(_provenance(old), _provenance(new))]
    first = first_change(old, new)
    if first:
        lines += [*_outcome(compared_run(old), compared_run(new)), f"first at  {first}"]
    return lines


def first_change(old: Path, new: Path) -> str:
    """The first message that differs: tick, key, field and both values; empty if none does."""
    tick = 1
    for before, now in zip_longest(_messages(old), _messages(new)):
        if before is None or now is None or (before.key, before.sequence) != (now.key, now.sequence):
            return f"tick {tick}: was {_named(before)}, now {_named(now)}"
        if before.data != now.data:
            field, then, today = first_field(decoded(before), decoded(now))
            return f"tick {tick}, {now.key}, {field}: was {then}, now {today}"
        tick += now.key == TOPICS["tick"].key
    return ""


def outcome(run: ComparedRun) -> str:
    """How a run ended, and how long its actions took."""
    actions = ", ".join(
        f"{a.action} {'' if a.outcome == 'done' else a.outcome + ' '}{a.actual_s:.1f}" for a in run.actions
    )
    return f"{run.result or 'no result'} in {run.total_s:.1f} s: {actions}"


def _outcome(before: ComparedRun, now: ComparedRun) -> Iterator[str]:
    was, is_now = outcome(before), outcome(now)
    if was != is_now:
        yield f"was       {was}"
    yield f"now       {is_now}" + ("" if was != is_now else " (as before)")


def _made_of(before: dict[str, Any], now: dict[str, Any]) -> Iterator[str]:
    """Models and settings that changed; the machine does not count, nor does a setting that is new."""
    names = sorted({*before["models"], *now["models"]})
    models = [name for name in names if before["models"].get(name) != now["models"].get(name)]
    if models:
        yield f"models    others: {', '.join(models)}"
    was, is_now = _leaves(before["config"]), _leaves(now["config"])
    for name, value in was.items():
        if is_now.get(name) != value:
            yield f"settings  {name} was {value}, now {is_now.get(name, 'gone')}"


def _leaves(settings: Any, name: str = "") -> dict[str, Any]:
    """Settings by their full names: "settings.refinement.horizon"."""
    if not isinstance(settings, dict):
        return {name: settings}
    inner = (_leaves(value, f"{name}.{key}".strip(".")) for key, value in settings.items())
    return {full: value for part in inner for full, value in part.items()}


def _provenance(path: Path) -> dict[str, Any]:
    return RecordedRuns(path).runs[0].provenance


def _messages(path: Path) -> Iterator[Recorded]:
    return (message for message in open_recording(path).messages() if message.key != PROVENANCE_KEY)


def _named(message: MESSAGE) -> str:
    return "the end" if message is None else f"{message.key} number {message.sequence}"
