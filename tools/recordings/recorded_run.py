"""Takes the executives' runs out of a recording, and gives every tick back what it was given."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tailor.executive.core.state import Inputs
from tailor.executive.replay import RecordedTick
from tailor.runtime.recordings.recording import Recorded, Recording, open_recording
from tailor.schemas.codec import decode, encode
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import Sample
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import type_of
from tailor.tools.recordings.executive_run import (
    PROVENANCE_KEY,
    TICK_KEY,
    RecordedRun,
    decoded,
    executives,
    in_order,
    take,
)

__all__ = ["PROVENANCE_KEY", "TICK_KEY", "RecordedRun", "RecordedRuns", "decoded"]

MAX_BYTES = 1_000_000_000  # a run has some 10 MB a minute
MAX_REASONS = 3  # that are told one by one: a file may hold any number of strangers
ANSWER_KEY = TOPICS["plan_answer"].key  # an executive's own, but an input of its core


class RecordedRuns:
    """All executives' runs in a recording, and the messages that they may have been given.

    Anyone may say something on exec/tick. A run is what one sender said that also told what it is made of; where nobody
    told, every sender of ticks has one. What cannot be read as a tick, or is a stranger's, is counted in `left_out`.
    """

    def __init__(self, path: Path) -> None:
        """Read the whole file; raises UsageError if it is none or holds no run."""
        self.path = path
        self.left_out: Counter[str] = Counter()  # messages on exec/tick that belong to no run, by reason
        self._heard: dict[tuple[str, str, int], Recorded] = {}
        recording = open_recording(path)
        everything = list(_bounded(recording))
        by_sender = {sender: RecordedRun(sender) for sender in executives(everything)}
        for message in everything:
            if message.sender in by_sender and message.key != ANSWER_KEY:
                self._take(by_sender[message.sender], message)
            else:
                self._heard[message.key, message.sender, message.sequence] = message
                if message.key == TICK_KEY:
                    self.left_out[f"said by {message.sender[:8] or 'nobody'}, not by an executive"] += 1
        self.runs = [run for run in by_sender.values() if run.ticks]
        if not self.runs:
            raise UsageError(f"{path}: {self._missing(recording)}, expected the recording of an executive's run")
        for run in self.runs:
            in_order(run)
        _ready_codecs(everything)

    def left_out_text(self) -> str:
        """One line for people on what was left out of exec/tick; empty if nothing was."""
        rows = [f"{count} {reason}" for reason, count in self.left_out.most_common(MAX_REASONS)]
        others = self.left_out.total() - sum(count for _, count in self.left_out.most_common(MAX_REASONS))
        text = ", ".join([*rows, f"{others} others"] if others else rows)
        return f"left out of {TICK_KEY}: {text}" if text else ""

    def _missing(self, recording: Recording) -> str:
        known = "; ".join(filter(None, (self.left_out_text(), recording.damage.text())))
        return f"no message of {TICK_KEY}" + (f" to be used ({known})" if known else "")

    def _take(self, run: RecordedRun, message: Recorded) -> None:
        try:
            wrong = take(run, message)
        except UsageError as error:
            raise UsageError(f"{self.path}: {error}") from None
        if wrong:
            self.left_out[wrong] += 1

    def ticks(self, run: RecordedRun) -> Iterator[RecordedTick]:
        """What each tick of a run was given; raises UsageError where the recording lacks it."""
        for number, report in enumerate(run.ticks, start=1):
            if report.tick != number:
                left = self.left_out_text()
                what = f"tick {number} is missing" + (f" ({left})" if left else "")
                raise UsageError(f"{self.path}: {what}, expected every tick from the first one on")
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
        if size > MAX_BYTES:
            raise UsageError(
                f"{recording.path}: more than {MAX_BYTES} bytes of messages, expected a piece (`tailor cut`)"
            )
        yield message


def _ready_codecs(messages: list[Recorded]) -> None:
    """Read and write one message of each of our types: that compiles the code for it, 2 ms a type, once a process."""
    for message in {message.ros_type: message for message in messages}.values():
        kind = type_of(message.ros_type)
        one = decode(kind, message.data) if kind is not None else None
        if one is not None and not isinstance(one, Rejected):
            encode(one)
