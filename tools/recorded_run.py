"""Takes one executive's run out of a recording: what it was made of, what every tick was given, what it answered."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from executive.core.state import Inputs
from executive.replay import RecordedTick
from runtime.recording import Recorded, Recording, open_recording
from schemas.codec import decode, encode
from schemas.errors import Rejected, UsageError
from schemas.json_text import table_of
from schemas.messages import Message, Provenance, Sample, TickReport
from schemas.topics import TOPICS
from schemas.typesystem import type_of

TICK_KEY = TOPICS["tick"].key
MOST_BYTES = 1_000_000_000  # a run has some 10 MB a minute
PROVENANCE_KEY = TOPICS["provenance"].key
ANSWER_KEY = TOPICS["plan_answer"].key  # an executive's own, but an input of its core


@dataclass(slots=True)
class RecordedRun:
    """One executive's run. `said` holds its messages by key, in the order of their sequence numbers."""

    sender: str
    provenance: dict[str, Any] = field(default_factory=dict)
    ticks: list[TickReport] = field(default_factory=list)
    said: dict[str, list[Recorded]] = field(default_factory=lambda: defaultdict(list))


class RecordedRuns:
    """All executives' runs in a recording, and the messages that they may have been given."""

    def __init__(self, path: Path) -> None:
        """Read the whole file; raises UsageError if it is none or holds no run."""
        self.path = path
        self._heard: dict[tuple[str, str, int], Recorded] = {}
        recording = open_recording(path)
        everything = list(_bounded(recording))
        executives = list(dict.fromkeys(m.sender for m in everything if m.key == TICK_KEY))
        if not executives:
            damage = f" ({recording.account.text()})" if recording.account.text() else ""
            raise UsageError(f"{path}: no message of {TICK_KEY}, expected the recording of an executive's run{damage}")
        self.runs = [RecordedRun(sender) for sender in executives]
        by_sender = {run.sender: run for run in self.runs}
        for message in everything:
            if message.sender in by_sender and message.key != ANSWER_KEY:
                self._take(by_sender[message.sender], message)
            else:
                self._heard[message.key, message.sender, message.sequence] = message
        for run in self.runs:
            _in_order(run)
        _ready_codecs(everything)

    def _take(self, run: RecordedRun, message: Recorded) -> None:
        try:
            _take(run, message)
        except UsageError as error:
            raise UsageError(f"{self.path}: {error}") from None

    def ticks(self, run: RecordedRun) -> Iterator[RecordedTick]:
        """What each tick of a run was given; raises UsageError where the recording lacks it."""
        for number, report in enumerate(run.ticks, start=1):
            if report.tick != number:
                raise UsageError(f"{self.path}: tick {number} is missing, expected every tick from the first one on")
            samples = tuple(
                self._sample(report.tick, *row)
                for row in zip(
                    report.input_keys,
                    report.input_senders,
                    report.input_sequences,
                    report.input_arrivals_ns,
                    strict=True,
                )
            )
            inputs = Inputs(samples, report.goal, report.skipped, report.stopping)
            yield RecordedTick(report.tick, report.now_ns, inputs, report.checks_granted)

    def inputs(self, tick: RecordedTick) -> list[bytes]:
        """The bytes of a tick's samples as they were recorded."""
        return [self._heard[s.key, s.sender, s.sequence].data for s in tick.inputs.samples]

    def _sample(self, tick: int, key: str, sender: str, sequence: int, arrival_ns: int) -> Sample:
        recorded = self._heard.get((key, sender, sequence))
        if recorded is None:
            raise UsageError(f"{self.path}: tick {tick} was given number {sequence} of {key}, which is not recorded")
        message = decoded(recorded)
        return Sample(key, message, arrival_ns, sequence, sender)


def _bounded(recording: Recording) -> Iterator[Recorded]:
    """The messages of our own types: all are kept in memory, and a small file may unpack to more than there is."""
    size = 0
    for message in recording.messages():
        if type_of(message.ros_type) is None:
            continue
        size += len(message.data)
        if size > MOST_BYTES:
            raise UsageError(
                f"{recording.path}: more than {MOST_BYTES} bytes of messages, expected a piece (`tailor cut`)"
            )
        yield message


def decoded(recorded: Recorded) -> Message:
    """The value of a recorded message of our own types; raises UsageError if it is damaged."""
    kind = type_of(recorded.ros_type)
    message = decode(kind, recorded.data) if kind is not None else Rejected(f"unknown type {recorded.ros_type}")
    if isinstance(message, Rejected):
        raise UsageError(f"{recorded.key} number {recorded.sequence}: {message.reason}")
    return message


def _ready_codecs(messages: list[Recorded]) -> None:
    """Read and write one message of each of our types: that compiles the code for it, 2 ms a type, once a process."""
    for message in {message.ros_type: message for message in messages}.values():
        kind = type_of(message.ros_type)
        one = decode(kind, message.data) if kind is not None else None
        if one is not None and not isinstance(one, Rejected):
            encode(one)


def _take(run: RecordedRun, message: Recorded) -> None:
    if message.key == PROVENANCE_KEY:
        said = decoded(message)
        if isinstance(said, Provenance):
            run.provenance = _table(said)
    elif message.key == TICK_KEY:
        report = decoded(message)
        if not isinstance(report, TickReport):
            raise UsageError(f"{TICK_KEY} number {message.sequence}: {message.ros_type}, expected reports of ticks")
        run.ticks.append(report)
    else:
        run.said[message.key].append(message)


def _table(said: Provenance) -> dict[str, Any]:
    table = table_of(said.json)
    if isinstance(table, Rejected):
        raise UsageError(f"{PROVENANCE_KEY}: {table.reason}, expected what an executive says of itself")
    return table


def _in_order(run: RecordedRun) -> None:
    run.ticks.sort(key=lambda report: report.tick)
    for messages in run.said.values():
        messages.sort(key=lambda message: message.sequence)
