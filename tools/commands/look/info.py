"""Tell what a recording holds: topics with rates and gaps, drops, damage, episodes, actions, modes and tick timing."""

from __future__ import annotations

import argparse
import json
from datetime import UTC, datetime
from typing import Any

from rich.table import Table

from tailor.runtime.recordings.recording import Recording, open_recording
from tailor.schemas.errors import Rejected
from tailor.schemas.json_text import table_of
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.terminal import table_console
from tailor.tools.recordings.survey import Stream, Survey, percentiles, survey

MAX_ROWS = 500  # of the table of topics: a run has some 30; laying out thousands takes minutes


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor info`."""
    parser.add_argument("file", help="recording (MCAP)")
    parser.add_argument("--json", action="store_true", help="tell it as JSON")


def run(arguments: argparse.Namespace) -> int:
    """0; 1 when the file is damaged or messages were dropped."""
    recording = open_recording(arguments.file)
    told = _told(recording, survey(recording))
    if arguments.json:
        print(json.dumps(told))
    else:
        _show(told)
    return 1 if told["damage"] or told["drops"] else 0


def _told(recording: Recording, found: Survey) -> dict[str, Any]:
    start_ns, end_ns = found.span_ns
    metadata = dict(recording.metadata())
    return {
        "file": str(recording.path),
        "bytes": recording.path.stat().st_size,
        "start": _time(start_ns) if found.streams else "",
        "duration_s": round((end_ns - start_ns) / 1e9, 3),
        "messages": sum(stream.count for stream in found.streams.values()),
        "damage": recording.damage.text(),
        "drops": {key: int(count) if count.isdecimal() else count for key, count in metadata.get("drops", {}).items()},
        "topics": [_stream(s) for s in sorted(found.streams.values(), key=lambda s: (s.key, s.first_ns))],
        "episodes": [{"goal": goal, "result": result} for goal, result in found.results],
        "actions": [
            {"action": a.action, "outcome": a.outcome, "predicted_s": a.predicted_s, "actual_s": a.actual_s}
            for a in found.actions
        ],
        "modes": dict(found.modes),
        "faults": found.faults,
        "driver_stops": found.stops,
        "ticks": {
            "late_ms": percentiles(found.late_ms),
            "work_ms": percentiles(found.work_ms),
            "skipped_periods": found.skipped,
        },
        "provenance": _parsed(metadata.get("provenance", {}).get("json", "{}")),
        "recorder": metadata.get("recorder", {}),
    }


def _stream(stream: Stream) -> dict[str, Any]:
    return {
        "key": stream.key,
        "type": stream.ros_type,
        "sender": stream.sender,
        "count": stream.count,
        "rate_hz": round(stream.rate_hz, 2),
        "longest_gap_s": round(stream.longest_gap_ns / 1e9, 3),
        "lost": stream.lost,
        "rejected": dict(stream.rejected),
    }


def _time(wall_ns: int) -> str:
    return datetime.fromtimestamp(wall_ns / 1e9, UTC).isoformat(timespec="milliseconds")


def _parsed(text: str) -> Any:
    table = table_of(text)
    return text if isinstance(table, Rejected) else table


def _show(told: dict[str, Any]) -> None:
    console = table_console()
    size, since = told["bytes"] / 1e6, f" from {told['start']}" if told["start"] else ""
    console.print(f"{told['file']}: {told['messages']} messages, {told['duration_s']:.1f} s{since}, {size:.2f} MB")
    if told["damage"]:
        console.print(f"damaged: {told['damage']}", style="red")
    for key, count in told["drops"].items():
        console.print(f"dropped: {count} of {plain(key)}", style="red")
    console.print(_topics(told["topics"][:MAX_ROWS]))
    if len(told["topics"]) > MAX_ROWS:
        console.print(f"and {len(told['topics']) - MAX_ROWS} topics more; --json tells all")
    if told["actions"]:
        console.print(_actions(told["actions"]))
    for episode in told["episodes"]:
        console.print(plain(f"episode {episode['goal']}: {episode['result']}"))
    for name, what in (("fault", told["faults"]), ("driver stopped", told["driver_stops"])):
        for reason in what:
            console.print(plain(f"{name}: {reason}"))
    if told["modes"]:
        ticks = told["ticks"]
        console.print("ticks by mode: " + ", ".join(f"{mode} {count}" for mode, count in told["modes"].items()))
        console.print(f"ticks late (ms): {ticks['late_ms']}, work (ms): {ticks['work_ms']}")
        console.print(f"periods skipped: {ticks['skipped_periods']}")


def _topics(rows: list[dict[str, Any]]) -> Table:
    table = _table(("key", "type", "sender"), ("count", "Hz", "longest gap s", "lost", "rejected"))
    for row in rows:
        numbers = (row["count"], row["rate_hz"], row["longest_gap_s"], row["lost"], sum(row["rejected"].values()))
        table.add_row(*map(plain, (row["key"], row["type"], row["sender"][:8])), *map(str, numbers))
    return table


def _actions(rows: list[dict[str, Any]]) -> Table:
    table = _table(("action", "outcome"), ("predicted s", "actual s", "error"))
    for row in rows:
        predicted, actual = row["predicted_s"], row["actual_s"]
        error = f"{(actual / predicted - 1):+.0%}" if predicted > 0 else ""
        table.add_row(plain(row["action"]), plain(row["outcome"]), f"{predicted:.2f}", f"{actual:.2f}", error)
    return table


def _table(words: tuple[str, ...], numbers: tuple[str, ...]) -> Table:
    table = Table(box=None)
    for name in words:
        table.add_column(name)
    for name in numbers:
        table.add_column(name, justify="right")
    return table
