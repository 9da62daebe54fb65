"""Index of the chunks of an MCAP file, on disk until the file is closed: memory does not grow with the recording.

mcap's Writer keeps one entry for each chunk in a list, 1.5 kB each: 9 MB an hour. This list takes its place.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from mcap.data_stream import RecordBuilder
from mcap.writer import Writer

CHUNK_INDEXES = "_Writer__chunk_indices"  # attribute of mcap's Writer
BLOCK_BYTES = 65_536  # of entries in memory: short recordings need no second file
_HEAD_BYTES = 9  # opcode, length


class ChunkIndexSpool:
    """The part of a list that mcap's Writer uses: append, and one iteration at the end."""

    def __init__(self, folder: Path) -> None:
        """`folder` takes the file, which has no name and vanishes with this process."""
        self._folder = folder
        self._file: IO[bytes] | None = None
        self._stored = 0  # bytes in the file that are whole entries
        self._pending = bytearray()

    def install(self, writer: Writer) -> None:
        """Take the place of a writer's list. It is private: if mcap renames it, memory grows and a test fails."""
        setattr(writer, CHUNK_INDEXES, self)

    def append(self, index: Any) -> None:
        """Keep the entry of one chunk."""
        builder: Any = RecordBuilder()
        index.write(builder)
        self._pending += builder.end()
        if len(self._pending) >= BLOCK_BYTES:
            self._store()

    def __iter__(self) -> Iterator[_Entry]:
        """All entries, oldest first; none if they cannot be read: a reader then reads the file from front to back."""
        try:
            stored = self._read()
        except OSError:
            return
        for records in (stored, bytes(self._pending)):
            at = 0
            while at < len(records):
                end = at + _HEAD_BYTES + int.from_bytes(records[at + 1 : at + _HEAD_BYTES], "little")
                yield _Entry(records[at:end])
                at = end

    def close(self) -> None:
        """Remove the file."""
        if self._file is not None:
            self._file.close()

    def _store(self) -> None:
        """Move the entries to the disk; they stay in memory while it is full, when no new chunks are made either."""
        try:
            if self._file is None:
                self._file = tempfile.TemporaryFile(dir=self._folder, buffering=0)  # noqa: SIM115
            self._file.seek(self._stored)
            if self._file.write(self._pending) == len(self._pending):
                self._stored += len(self._pending)
                self._pending = bytearray()
        except OSError:
            return

    def _read(self) -> bytes:
        if self._file is None:
            return b""
        self._file.seek(0)
        return self._file.read(self._stored)


@dataclass(frozen=True, slots=True)
class _Entry:
    """Bytes of one record, written as they are."""

    record: bytes

    def write(self, builder: Any) -> None:
        builder.write(self.record)
