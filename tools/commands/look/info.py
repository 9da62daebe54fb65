"""Summarise a recording: topics with rates and gaps, drops, damage, runs, actions, modes and tick timing."""

from __future__ import annotations

import argparse
import json
from datetime import UTC, datetime
from typing import Any

from rich.table import Table

from tailor.runtime.recordings.recording import Recording, open_recording
from tailor.schemas.errors import Rejected
from tailor.schemas.parsed_files import table_of
from tailor.schemas.reason_text import reason_text
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.terminal import table_console
from tailor.tools.recordings.survey import Stream, Survey, percentiles, survey

MAX_DIGITS = 20  # of a count; Python reads none of thousands
MAX_ROWS = 500  # of the table of topics: a run has about 30, and formatting thousands takes minutes


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor info`."""
    parser.add_argument("file", help="recording (MCAP)")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: argparse.Namespace) -> int:
    """0; 1 if the file is damaged or messages were dropped."""
    recording = open_recording(arguments.file)
    summary = _summary(recording, survey(recording))
    if arguments.json:
        print(json.dumps(summary))
    else:
        _show(summary)
    return 1 if summary["damage"] or summary["drops"] else 0


def _summary(recording: Recording, counted: Survey) -> dict[str, Any]:
    start_ns, end_ns = counted.span_ns
    metadata = dict(recording.metadata())
    return {
        "file": str(recording.path),
        "bytes": recording.path.stat().st_size,
        "start": _time(start_ns) if counted.streams else "",
        "duration_s": round((end_ns - start_ns) / 1e9, 3),
        "messages": sum(stream.count for stream in counted.streams.values()),
        "damage": recording.damage.text(),
        "drops": _counts(metadata.get("drops", {})),
        "mixed": _counts(metadata.get("mixed", {})),
        "topics": [_stream(s) for s in sorted(counted.streams.values(), key=lambda s: (s.key, s.first_ns))],
        "episodes": [{"goal": goal, "result": result} for goal, result in counted.results],
        "actions": [
            {
                "action": a.action,
                "outcome": a.outcome,
                "predicted_s": a.predicted_s,
                "actual_s": a.actual_s,
                "reason": a.reason,
                "detail": a.detail,
            }
            for a in counted.actions
        ],
        "modes": dict(counted.modes),
        "faults": counted.faults,
        "driver_stops": counted.stops,
        "ticks": {
            "late_ms": percentiles(counted.late_ms),
            "work_ms": percentiles(counted.work_ms),
            "skipped_periods": counted.skipped,
        },
        "provenance": _parsed(metadata.get("provenance", {}).get("json", "{}")),
        "recorder": metadata.get("recorder", {}),
    }


def _counts(entries: dict[str, str]) -> dict[str, int | str]:
    return {key: int(n) if n.isdecimal() and len(n) < MAX_DIGITS else n for key, n in entries.items()}


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
    """The JSON object in a text; the text itself if it is none, or has a NaN or Infinity, which JSON has not."""
    table = table_of(text)
    if isinstance(table, Rejected):
        return text
    try:
        json.dumps(table, allow_nan=False)
    except ValueError:
        return text
    return table


def _show(summary: dict[str, Any]) -> None:
    console = table_console()
    size, since = summary["bytes"] / 1e6, f" from {summary['start']}" if summary["start"] else ""
    console.print(
        f"{plain(summary['file'])}: {summary['messages']} messages, {summary['duration_s']:.1f} s{since}, {size:.2f} MB"
    )
    if summary["damage"]:
        console.print(f"damaged: {summary['damage']}", style="red")
    for key, count in summary["drops"].items():
        console.print(f"dropped: {count} of {plain(key)}", style="red")
    for key, count in summary["mixed"].items():
        console.print(f"without their sender, of too many: {count} of {plain(key)}", style="red")
    console.print(_topics(summary["topics"][:MAX_ROWS]))
    if len(summary["topics"]) > MAX_ROWS:
        console.print(f"and {len(summary['topics']) - MAX_ROWS} topics more; --json prints all")
    if summary["actions"]:
        console.print(_actions(summary["actions"]))
    for episode in summary["episodes"]:
        console.print(plain(f"episode {episode['goal']}: {episode['result']}"))
    for name, reasons in (("fault", summary["faults"]), ("driver stopped", summary["driver_stops"])):
        for reason in reasons:
            console.print(plain(f"{name}: {reason}"))
    if summary["modes"]:
        ticks = summary["ticks"]
        modes = ", ".join(f"{mode} {count}" for mode, count in summary["modes"].items())
        console.print(plain(f"ticks by mode: {modes}"))
        console.print(f"ticks, ms: {_spread('late', ticks['late_ms'])}; {_spread('work', ticks['work_ms'])}")
        console.print(f"periods skipped: {ticks['skipped_periods']}")


def _spread(name: str, percentile: dict[str, float]) -> str:
    return f"{name} " + ", ".join(f"{key} {value:.1f}" for key, value in percentile.items())


def _topics(rows: list[dict[str, Any]]) -> Table:
    table = _table(("key", "type", "sender"), ("count", "Hz", "longest gap s", "lost", "rejected"))
    for row in rows:
        numbers = (row["count"], row["rate_hz"], row["longest_gap_s"], row["lost"], sum(row["rejected"].values()))
        table.add_row(*map(plain, (row["key"], row["type"], row["sender"][:8])), *map(str, numbers))
    return table


def _actions(rows: list[dict[str, Any]]) -> Table:
    table = _table(("action", "outcome"), ("predicted s", "actual s", "error"))
    table.add_column("why")
    for row in rows:
        predicted, actual = row["predicted_s"], row["actual_s"]
        known = row["outcome"] == "done" and predicted > 0  # that another one took less time is no error of its model
        error = f"{round(100 * (actual / predicted - 1)):+d}%" if known else ""
        why = reason_text(row["reason"], row["detail"])
        table.add_row(*map(plain, (row["action"], row["outcome"], f"{predicted:.2f}", f"{actual:.2f}", error, why)))
    return table


def _table(words: tuple[str, ...], numbers: tuple[str, ...]) -> Table:
    table = Table(box=None)
    for name in words:
        table.add_column(name, no_wrap=name == words[0])  # a narrow terminal cuts off the others
    for name in numbers:
        table.add_column(name, justify="right")
    return table
