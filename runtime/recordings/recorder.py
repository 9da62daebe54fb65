"""Recorder: a plain subscriber that writes the messages of the bus into MCAP files.

It never blocks a publisher: the bus is drained at once, and messages that the disk cannot take are counted as dropped.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from tailor.runtime.bus.encoding import named_type
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue, count_key
from tailor.runtime.clock import wall_ns
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.runtime.recordings.recording_metadata import RecordingMetadata
from tailor.runtime.recordings.selection import Selection

FLUSH_NS = 600_000_000  # with one period and the time of the disk, kill -9 loses less than a second
NOTE_NS = 10_000_000_000  # between two records of counts, which stay in memory until the file is closed
MAX_KINDS = 1000  # limit of the cache by key and encoding; a bus has about 30


@dataclass(frozen=True, slots=True)
class Limits:
    """Size and duration after which a new file begins; 0 means never."""

    max_bytes: int = 0
    max_ns: int = 0

    @property
    def splits(self) -> bool:
        """Whether the recording may consist of several files."""
        return bool(self.max_bytes or self.max_ns)


@dataclass(slots=True)
class Health:
    """State of a recording, for display."""

    messages: int = 0
    unwritten: int = 0  # of files that could not be closed for want of space: not among `messages`
    bytes: int = 0
    files: list[Path] = field(default_factory=list)
    drops: Counter[str] = field(default_factory=Counter)
    mixed: Counter[str] = field(default_factory=Counter)  # messages recorded without their sender, by key
    disk_error: str = ""  # last error of the disk, empty if none


class Recorder:
    """Records the bus; call `step` about ten times a second from one thread, and `close` at the end."""

    def __init__(
        self, path: Path, queue: IngestQueue, selection: Selection, limits: Limits, metadata: RecordingMetadata
    ) -> None:
        """Create the (first) file.

        Args:
          path: New file; NAME_000.mcap and so on if the limits split it.
          queue: Received messages.
          selection: Messages to record.
          limits: Limits of one file.
          metadata: Metadata of every file; provenance received on the bus is added.

        Raises:
          FileExistsError: The file exists.
          OSError: The file cannot be created.
        """
        self.health = Health()
        self._path, self._queue, self._selection = path, queue, selection
        self._limits, self._metadata = limits, metadata
        self._wanted: dict[tuple[str, str], bool] = {}  # by key and encoding
        self._dropped: Counter[str] = Counter()  # because the disk was full, or the file had too many keys
        self._closed_messages = self._closed_bytes = self._closed_unwritten = 0
        self._closed_mixed: Counter[str] = Counter()
        self._flush_at_ns = self._note_at_ns = 0
        self._split_error = ""  # why the next file cannot be created
        self._begun_ns: int | None = None  # monotonic time of the first message of the present file
        self._writer = self._next_writer()

    def step(self, now_ns: int) -> None:
        """Write received messages; flush and split when due. `now_ns` is monotonic."""
        for raw in self._queue.drain():
            self._keep(raw)
        if self._begun_ns is None and self._writer.messages:
            self._begun_ns = now_ns
        if now_ns >= self._flush_at_ns:
            self._flush_at_ns = now_ns + FLUSH_NS
            self._count_losses()
            if now_ns >= self._note_at_ns:
                self._note_at_ns = now_ns + (NOTE_NS if self._note_losses() else 0)
            self._writer.flush()
            self._split_when_full(now_ns)
        self._report()

    def close(self) -> Health:
        """Write the remaining messages and the footer."""
        for raw in self._queue.drain():
            self._keep(raw)
        self._count_losses()
        self._note_losses()
        self._writer.close()
        self._report()
        return self.health

    def _keep(self, raw: Raw) -> None:
        if not raw.is_put or not self._wants(raw.key, raw.encoding):
            return
        if self._writer.is_full or not self._writer.write(raw, raw.received_wall_ns or wall_ns()):
            count_key(self._dropped, raw.key)
            return
        if self._metadata.observe(raw):
            self._writer.add_metadata("provenance", self._metadata.entries["provenance"])

    def _wants(self, key: str, encoding: str) -> bool:
        """Whether to record messages of this key and encoding; cached."""
        wanted = self._wanted.get((key, encoding))
        if wanted is None:
            if len(self._wanted) >= MAX_KINDS:
                self._wanted.clear()
            wanted = self._wanted[key, encoding] = self._selection.wants(key, named_type(encoding))
        return wanted

    def _count_losses(self) -> None:
        self.health.drops = self._queue.drops + self._dropped
        self.health.mixed = self._closed_mixed + self._writer.mixed

    def _note_losses(self) -> bool:
        """Write the counts that have changed into the file; False if none has."""
        changed = False
        for name, counts in (("drops", self.health.drops), ("mixed", self.health.mixed)):
            entries = {key: str(count) for key, count in sorted(counts.items())}
            if entries and self._metadata.put(name, entries):
                self._writer.add_metadata(name, entries)
                changed = True
        return changed

    def _split_when_full(self, now_ns: int) -> None:
        too_long = self._limits.max_ns and self._begun_ns is not None and now_ns - self._begun_ns >= self._limits.max_ns
        too_big = self._limits.max_bytes and self._writer.bytes >= self._limits.max_bytes
        if not (too_long or too_big) or self._writer.disk_error:
            return
        self._note_losses()
        try:
            following = self._next_writer()
        except OSError as error:  # the present file goes on, and the next flush tries again
            self._split_error = error.strerror or str(error)
            return
        self._split_error = ""
        self._writer.close()
        self._closed_mixed += self._writer.mixed
        self._closed_messages += self._writer.messages
        self._closed_unwritten += self._writer.unwritten
        self._closed_bytes += self._writer.bytes
        self._writer, self._begun_ns = following, None

    def _next_writer(self) -> McapWriter:
        part = len(self.health.files)
        name = f"{self._path.stem}_{part:03d}{self._path.suffix}" if self._limits.splits else self._path.name
        metadata = {**self._metadata.entries, "part": {"number": str(part)}}
        writer = McapWriter(self._path.with_name(name), metadata, background=True)
        self.health.files.append(writer.path)
        return writer

    def _report(self) -> None:
        health = self.health
        health.messages = self._closed_messages + self._writer.messages
        health.unwritten = self._closed_unwritten + self._writer.unwritten
        health.bytes = self._closed_bytes + self._writer.bytes
        health.disk_error = self._writer.disk_error or self._split_error
