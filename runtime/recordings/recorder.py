"""The recorder: takes what the bus says, and keeps it on tape, whatever the disk does. A plain subscriber.

Nothing that happens here can hold up anyone: the bus is drained at once, and what the disk cannot take is counted.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.clock import wall_ns
from tailor.runtime.recordings.mcap_writer import ENCODING, McapWriter
from tailor.runtime.recordings.recording_metadata import RecordingMetadata
from tailor.runtime.recordings.selection import Selection

FLUSH_NS = 600_000_000  # with a turn and the disk's own time, kill -9 loses less than a second
MAX_KINDS = 10_000  # of messages that are remembered: a bus has some 30


@dataclass(frozen=True, slots=True)
class Limits:
    """When to go on in a new file; 0 means never."""

    most_bytes: int = 0
    most_ns: int = 0

    @property
    def splits(self) -> bool:
        """Whether the recording may take several files."""
        return bool(self.most_bytes or self.most_ns)


@dataclass(slots=True)
class Health:
    """How the recording is doing, for people."""

    messages: int = 0
    bytes: int = 0
    files: list[Path] = field(default_factory=list)
    drops: Counter[str] = field(default_factory=Counter)
    trouble: str = ""  # what the disk said last


class Recorder:
    """Call `step` some ten times a second from one thread, and `close` at the end."""

    def __init__(
        self,
        path: Path,
        intake: IngestQueue,
        selection: Selection,
        limits: Limits,
        facts: RecordingMetadata,
    ) -> None:
        """Create the (first) file.

        Args:
          path: Of the file; when the limits split it, of NAME_000.mcap and so on.
          intake: Where the messages wait.
          selection: Which of them to keep.
          limits: When to split.
          facts: Metadata for every file; grows with what is heard.
        """
        self.health = Health()
        self._path, self._intake, self._selection = path, intake, selection
        self._limits, self._facts = limits, facts
        self._wanted: dict[tuple[str, str], bool] = {}  # by key and encoding
        self._dropped: Counter[str] = Counter()  # for want of disk
        self._closed_messages = self._closed_bytes = 0
        self._flush_at_ns = 0
        self._tape = self._next_tape()

    def step(self, now_ns: int) -> None:
        """Write what has arrived; flush when it is time. `now_ns` is monotonic."""
        for raw in self._intake.drain():
            self._keep(raw)
        if now_ns >= self._flush_at_ns:
            self._flush_at_ns = now_ns + FLUSH_NS
            self._note_drops()
            self._tape.flush()
            self._split_when_full()
        self._report()

    def close(self) -> Health:
        """Write what is left, and the footer."""
        for raw in self._intake.drain():
            self._keep(raw)
        self._note_drops()
        self._tape.close()
        self._report()
        return self.health

    def _keep(self, raw: Raw) -> None:
        if not raw.is_put or not self._wants(raw.key, raw.encoding):
            return
        if self._tape.stuck:
            self._dropped[raw.key] += 1
            return
        self._tape.write(raw, raw.received_wall_ns or wall_ns())
        if self._facts.observe(raw):
            self._tape.note("provenance", self._facts.entries["provenance"])

    def _wants(self, key: str, encoding: str) -> bool:
        """Whether to keep messages like this; worked out once for each kind."""
        found = self._wanted.get((key, encoding))
        if found is None:
            if len(self._wanted) >= MAX_KINDS:
                self._wanted.clear()
            found = self._wanted[key, encoding] = self._selection.wants(key, encoding.removeprefix(ENCODING))
        return found

    def _note_drops(self) -> None:
        drops = self._intake.drops + self._dropped
        if drops != self.health.drops:
            self.health.drops = drops
            self._facts.put("drops", {key: str(count) for key, count in sorted(drops.items())})
            self._tape.note("drops", self._facts.entries["drops"])

    def _split_when_full(self) -> None:
        first_ns = self._tape.first_ns
        too_long = self._limits.most_ns and first_ns is not None and wall_ns() - first_ns >= self._limits.most_ns
        too_big = self._limits.most_bytes and self._tape.bytes >= self._limits.most_bytes
        if (too_long or too_big) and not self._tape.trouble:
            self._tape.close()
            self._closed_messages += self._tape.messages
            self._closed_bytes += self._tape.bytes
            self._tape = self._next_tape()

    def _next_tape(self) -> McapWriter:
        part = len(self.health.files)
        name = f"{self._path.stem}_{part:03d}{self._path.suffix}" if self._limits.splits else self._path.name
        tape = McapWriter(self._path.with_name(name), {**self._facts.entries, "part": {"number": str(part)}})
        self.health.files.append(tape.path)
        return tape

    def _report(self) -> None:
        health = self.health
        health.messages = self._closed_messages + self._tape.messages
        health.bytes = self._closed_bytes + self._tape.bytes
        health.trouble = self._tape.trouble
