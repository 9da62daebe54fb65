"""Tables and JSON of a soak."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import asdict, fields
from typing import Any

from rich.table import Table

from tailor.tools.soak.faults.scene import FaultRecord
from tailor.tools.soak.judging.slopes import Growth
from tailor.tools.soak.judging.violations import Violation


def fault_rows(records: Iterable[FaultRecord]) -> list[dict[str, Any]]:
    """One row for each kind of fault: count, and the worst of each time (s)."""
    kinds: dict[str, list[FaultRecord]] = defaultdict(list)
    for record in records:
        kinds[record.name].append(record)
    return [
        {
            "fault": name,
            "row": same[0].row,
            "count": len(same),
            "in_motion": sum(record.moving for record in same),
            **{f"worst_{key}": _worst(same, key) for key in ("zero_s", "rest_s", "back_s", "again_s")},
            "sent": sum(record.sent for record in same),
            "refused": sum(record.refused for record in same),
            "notes": sorted({note for record in same for note in record.notes}),
        }
        for name, same in sorted(kinds.items(), key=lambda pair: (pair[1][0].row, pair[0]))
    ]


def _worst(records: Iterable[FaultRecord], key: str) -> float | None:
    values = [getattr(record, key) for record in records]
    known = [value for value in values if value is not None]
    return round(max(known), 3) if known else None


def fault_table(rows: Iterable[Mapping[str, Any]]) -> Table:
    """Table of `fault_rows`."""
    table = Table(title="faults; worst times in s", caption="again: from people's arming to motion")
    for column in ("row", "fault", "count", "in motion", "zero", "rest", "back", "again", "sent", "refused"):
        table.add_column(column, justify="left" if column == "fault" else "right")
    keys = ("row", "fault", "count", "in_motion", "worst_zero_s", "worst_rest_s", "worst_back_s", "worst_again_s")
    for row in rows:
        table.add_row(*(_cell(row[key]) for key in (*keys, "sent", "refused")))
    return table


def memory_rows(growths: Mapping[tuple[str, str, int], Growth]) -> list[dict[str, Any]]:
    """One row for each process, by robot, name and process id; slopes in MB/h."""
    return [
        {"robot": robot, "process": name, "pid": pid, **asdict(growth), "flat": growth.flat}
        for (robot, name, pid), growth in growths.items()
    ]


def memory_table(rows: Iterable[Mapping[str, Any]]) -> Table:
    """Table of `memory_rows`: those with a slope, or all if there is none."""
    rows = list(rows)
    rows = [row for row in rows if row["slope"] is not None] or rows
    table = Table(
        title="own memory, without pages of files", caption="slope after the first ten minutes, 95 % interval"
    )
    for column in ("process", "minutes", "first MB", "last MB", "slope MB/h"):
        table.add_column(column, justify="left" if column == "process" else "right")
    for row in rows:
        slope = row["slope"]
        text = "" if slope is None else f"{slope:.2f} ({row['low']:.2f} to {row['high']:.2f})"
        name = f"{row['robot']} {row['process']}"
        table.add_row(name, f"{row['minutes']:.1f}", f"{row['first_mb']:.1f}", f"{row['last_mb']:.1f}", text)
    return table


def violation_rows(violations: Iterable[Violation]) -> list[dict[str, Any]]:
    """One row for each violation."""
    return [{**asdict(each), "invariant": each.invariant.name, "excused": each.excused} for each in violations]


def violation_line(row: Mapping[str, Any]) -> str:
    """One line for a row of `violation_rows`."""
    head = "late in a stall" if row["excused"] else "VIOLATION"
    return f"{head} at {row['time_s']:.1f} s, {row['robot']}: {row['invariant']}: {row['detail']}; after {row['fault']}"


def record_row(record: FaultRecord) -> dict[str, Any]:
    """A fault and its consequences as plain values."""
    hidden = ("at_ns", "back_when", "back_limit_s", "back_late")
    return {field.name: getattr(record, field.name) for field in fields(record) if field.name not in hidden}


def _cell(value: Any) -> str:
    return "" if value is None or value == 0 else f"{value:.2f}" if isinstance(value, float) else str(value)
