"""Messages of one executive in a recording: ticks, provenance, and all other messages by key."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sized
from dataclasses import dataclass, field
from typing import Any

from tailor.runtime.recordings.recording import Recorded
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import Message, Provenance, TickReport
from tailor.schemas.parsed_files import table_of
from tailor.schemas.topics import TOPICS

TICK_KEY = TOPICS["tick"].key
PROVENANCE_KEY = TOPICS["provenance"].key


@dataclass(slots=True)
class RecordedRun:
    """Run of one executive; `published` holds its messages by key, ordered by sequence number."""

    sender: str
    fault: str = ""  # of its provenance; the run is then no executive's
    provenance: dict[str, Any] = field(default_factory=dict)
    ticks: list[TickReport] = field(default_factory=list)
    published: dict[str, list[Recorded]] = field(default_factory=lambda: defaultdict(list))


def decoded(recorded: Recorded) -> Message:
    """Value of a recorded message of a Tailor type; raises UsageError if it is damaged."""
    value = recorded.value()
    if not isinstance(value, Message):
        reason = f"unknown type {recorded.ros_type}" if value is None else value.reason
        raise UsageError(f"{recorded.key} number {recorded.sequence}: {reason}")
    return value


def executives(messages: Iterable[Recorded]) -> list[str]:
    """Senders of both ticks and provenance; senders of ticks if there is no provenance. In order of appearance."""
    keys: dict[str, set[str]] = defaultdict(set)
    for message in messages:
        keys[message.sender].add(message.key)
    ticking = [sender for sender, published in keys.items() if TICK_KEY in published]
    return [sender for sender in ticking if PROVENANCE_KEY in keys[sender]] or ticking


def add(run: RecordedRun, message: Recorded) -> str:
    """Add a message to its run; returns the reason if it is not usable, or ""."""
    if message.key == PROVENANCE_KEY:
        provenance = decoded(message)
        if isinstance(provenance, Provenance):
            run.provenance = _table(provenance)
    elif message.key == TICK_KEY:
        report = message.value()
        if not isinstance(report, TickReport):
            return report.reason if isinstance(report, Rejected) else message.ros_type
        if len({len(column) for column in _inputs(report)}) > 1:
            return "with inputs that lack key, sender, number or arrival"
        run.ticks.append(report)
    else:
        run.published[message.key].append(message)
    return ""


def _inputs(report: TickReport) -> tuple[Sized, ...]:
    """What a tick reports of its inputs, a column each."""
    return report.input_keys, report.input_senders, report.input_sequences, report.input_arrivals_ns


def _table(provenance: Provenance) -> dict[str, Any]:
    table = table_of(provenance.json)
    if isinstance(table, Rejected):
        raise UsageError(f"{PROVENANCE_KEY}: {table.reason}, expected the provenance of an executive")
    return table


def sort_by_number(run: RecordedRun) -> None:
    """Sort ticks and messages of a run by their numbers."""
    run.ticks.sort(key=lambda report: report.tick)
    for messages in run.published.values():
        messages.sort(key=lambda message: message.sequence)
