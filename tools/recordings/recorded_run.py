"""Extracts the runs of executives from a recording, with the inputs of every tick."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tailor.executive.core.state import Inputs
from tailor.executive.replay import RecordedTick
from tailor.runtime.recordings.recording import Recorded, Recording, open_recording
from tailor.schemas.codec import encode
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import Message, Sample
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import type_of
from tailor.tools.recordings.executive_run import TICK_KEY, RecordedRun, add, decoded, executives, sort_by_number

MAX_BYTES = 1_000_000_000  # a run has about 10 MB a minute
HEAD_BYTES = 200  # of memory for each message beside its data, which may be empty
MAX_REASONS = 3  # listed separately: a file may hold any number of foreign senders
ANSWER_KEY = TOPICS["plan_answer"].key  # published by the executive, but an input of its core


class RecordedRuns:
    """All runs of executives in a recording, and the messages that may be inputs of their ticks.

    Anyone may publish on exec/tick. A run consists of the messages of one sender that also published provenance which
    can be read; without any provenance, every sender of ticks has a run. Other messages on exec/tick are counted in
    `left_out`. `dropped` are the keys of which the recorder dropped messages.
    """

    def __init__(self, path: Path) -> None:
        """Read the whole file; raises UsageError if it is not a recording or holds no run."""
        self.path = path
        self.left_out: Counter[str] = Counter()  # messages on exec/tick of no run, by reason
        self._inputs: dict[tuple[str, str, int], Recorded] = {}
        self._unnumbered: Counter[tuple[str, str]] = Counter()  # messages without a number, by key and sender
        recording = open_recording(path)
        everything = list(_bounded(recording))
        self.damage = recording.damage  # of the file
        self.dropped = {key for name, counts in recording.metadata() if name == "drops" for key in counts}
        by_sender = {sender: RecordedRun(sender) for sender in executives(everything)}
        for message in everything:
            # of equal numbers the first one: an executive refuses the others
            first = self._inputs.setdefault((message.key, message.sender, message.sequence), message)
            if message.sequence == 0:
                self._unnumbered[message.key, message.sender] += 1
            elif first is not message and first.data == message.data:
                continue  # as in a file that two recordings of one run were merged into
            if message.key != ANSWER_KEY:
                if message.sender in by_sender:
                    self._add(by_sender[message.sender], message)
                elif message.key == TICK_KEY:
                    self.left_out[f"from {message.sender[:8] or 'an unknown sender'}, not an executive"] += 1
        ticking = [run for run in by_sender.values() if run.ticks]
        self.runs = [run for run in ticking if not run.fault]
        if ticking and not self.runs:
            raise UsageError(f"{path}: {ticking[0].fault}")
        for run in ticking:
            if run.fault:
                self.left_out[f"from {run.sender[:8]}, whose provenance is damaged"] += len(run.ticks)
        if not self.runs:
            raise UsageError(f"{path}: {self._missing(recording)}, expected the recording of a run")
        for run in self.runs:
            sort_by_number(run)
        _compile_codecs(everything)

    def left_out_text(self) -> str:
        """Summary of the ignored messages on exec/tick in one line; empty if there are none."""
        listed = [f"{count} {reason}" for reason, count in self.left_out.most_common(MAX_REASONS)]
        others = self.left_out.total() - sum(count for _, count in self.left_out.most_common(MAX_REASONS))
        text = ", ".join([*listed, f"{others} others"] if others else listed)
        return f"ignored on {TICK_KEY}: {text}" if text else ""

    def _missing(self, recording: Recording) -> str:
        details = "; ".join(filter(None, (self.left_out_text(), recording.damage.text())))
        return f"no usable message of {TICK_KEY} ({details})" if details else f"no message of {TICK_KEY}"

    def _add(self, run: RecordedRun, message: Recorded) -> None:
        try:
            problem = add(run, message)
        except UsageError as error:
            run.fault = str(error)
            return
        if problem:
            self.left_out[problem] += 1

    def ticks(self, run: RecordedRun) -> Iterator[RecordedTick]:
        """Inputs of each tick of a run; raises UsageError if the recording lacks some."""
        for number, report in enumerate(run.ticks, start=1):
            if report.tick != number:
                ignored = self.left_out_text()
                problem = f"tick {number} is missing" + (f" ({ignored})" if ignored else "")
                raise UsageError(f"{self.path}: {problem}, expected every tick from the first one on")
            samples = tuple(
                self._sample(report.tick, *sample)
                for sample in zip(
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
        """Recorded bytes of the samples of a tick."""
        return [self._inputs[s.key, s.sender, s.sequence].data for s in tick.inputs.samples]

    def _sample(self, tick: int, key: str, sender: str, sequence: int, arrival_ns: int) -> Sample:
        recorded = self._inputs.get((key, sender, sequence))
        if recorded is None:
            raise UsageError(f"{self.path}: tick {tick} read number {sequence} of {key}, which is not recorded")
        if sequence == 0 and (count := self._unnumbered[key, sender]) > 1:
            problem = f"tick {tick} read one of {count} messages of {key} without numbers"
            raise UsageError(f"{self.path}: {problem}, expected numbers, as nothing else tells which")
        message = decoded(recorded)
        return Sample(key, message, arrival_ns, sequence, sender)


def _bounded(recording: Recording) -> Iterator[Recorded]:
    """Messages of Tailor's types, at most MAX_BYTES: they are kept in memory, and a small file may unpack to more."""
    size = 0
    for message in recording.messages():
        if type_of(message.ros_type) is None:
            continue
        size += HEAD_BYTES + len(message.data)
        if size > MAX_BYTES:
            raise UsageError(
                f"{recording.path}: more than {MAX_BYTES} bytes of messages, expected less (see `tailor cut`)"
            )
        yield message


def _compile_codecs(messages: list[Recorded]) -> None:
    """Decode and encode one message of each type; this compiles their codecs, 2 ms each, once a process."""
    for message in {message.ros_type: message for message in messages}.values():
        if isinstance(value := message.value(), Message):
            encode(value)
