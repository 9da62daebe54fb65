"""Reads the records of an MCAP file from front to back, in whatever state, and reports the damage.

Trusts no length: a record must lie inside the file, a chunk must not unpack to more than MAX_CHUNK_BYTES.
"""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import IO, Any

import lz4.frame  # type: ignore[import-untyped]
import zstandard
from mcap import records as r
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode

from tailor.runtime.recordings.mcap.chunk import records_of
from tailor.runtime.recordings.mcap.file_end import HEAD, MAGIC, FileEnd, read_end
from tailor.schemas.errors import UsageError

MAX_CHUNK_BYTES = 64_000_000  # chunks of ros2 bag have 0.8 MB, the largest of other tools a few dozen
MAX_RECORD_BYTES = 128_000_000
WINDOW_BYTES = 1_000_000
DATA_END_BYTES = 4  # a checksum
CHUNK_HEAD_BYTES = 45  # up to the end of the compression's name: opcode, 5 numbers of 8 or 4 bytes, length, name
_START = re.compile(rb"\x06.{36}(?:\x04\0{3}zstd|\x03\0{3}lz4|\0{4})|" + re.escape(MAGIC), re.DOTALL)
_FIRST = (b"\x06", MAGIC[:1])  # bytes of which _START begins with one
MESSAGES, ATTACHMENTS = (Opcode.CHUNK, Opcode.MESSAGE), (Opcode.ATTACHMENT,)  # records with what a file is large by
_KINDS: dict[int, Any] = {
    Opcode.HEADER: r.Header,
    Opcode.SCHEMA: r.Schema,
    Opcode.CHANNEL: r.Channel,
    Opcode.METADATA: r.Metadata,
    Opcode.CHUNK: r.Chunk,
}
# An impossible length inside a record overflows, or takes more memory than there is.
DAMAGE = (
    *(McapError, struct.error, ValueError, zstandard.ZstdError, RuntimeError, zlib.error, EOFError),
    *(OverflowError, MemoryError),
)
MOST_REASONS = 3  # that a report names


@dataclass(slots=True)
class DamageReport:
    """Damage found by a scan."""

    chunks: int = 0
    damaged_chunks: int = 0
    lost_bytes: int = 0  # in damaged records, or after the last valid record
    complete: bool = False  # the file ends with a footer
    reasons: list[str] = field(default_factory=list)  # the first ones

    def text(self) -> str:
        """Summary in one line; empty for an undamaged file."""
        if self.complete and not self.damaged_chunks and not self.lost_bytes and not self.reasons:
            return ""
        footer = "" if self.complete else "no footer; "
        reasons = f" ({'; '.join(self.reasons)})" if self.reasons else ""
        chunks = f"{self.chunks} chunks intact, {self.damaged_chunks} damaged"
        return f"{footer}{chunks}, {self.lost_bytes} bytes lost{reasons}"

    def add_loss(self, size: int, reason: str) -> None:
        """Record that `size` bytes were lost."""
        self.lost_bytes += size
        if len(self.reasons) < MOST_REASONS:
            self.reasons.append(reason)


def scan(path: Path, damage: DamageReport, with_chunks: bool = True, with_attachments: bool = False) -> Iterator[Any]:
    """Header, schemas, channels, messages and metadata in file order; fills in `damage`.

    Args:
      path: The file.
      damage: Filled in; complete when the iterator is exhausted.
      with_chunks: False skips all messages, which is fast.
      with_attachments: Whether attachments are read, too, which other tools write.

    Raises:
      UsageError: The file is missing, or not an MCAP file.
    """
    try:
        if path.is_fifo():  # waited for until somebody writes; and no index of it can be read
            raise UsageError(f"{path}: is a pipe, expected a recording in a file")
        with path.open("rb") as file:
            size = path.stat().st_size
            if file.read(len(MAGIC)) != MAGIC:
                raise UsageError(f"{path}: not an MCAP file")
            end = read_end(file, size)
            for opcode, data in end.declarations(file):
                yield from _one(_KINDS[opcode].read, data, DamageReport())
            file.seek(len(MAGIC))
            skipped = frozenset(() if with_chunks else MESSAGES) | frozenset(() if with_attachments else ATTACHMENTS)
            yield from _records(file, size, damage, skipped, end)
            damage.complete = end.start >= 0
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected a recording") from error


def _records(file: IO[bytes], size: int, damage: DamageReport, skipped: frozenset[int], end: FileEnd) -> Iterator[Any]:
    while True:
        start = file.tell()
        head = file.read(HEAD.size)
        if len(head) < HEAD.size:
            damage.add_loss(len(head), "its index or footer is damaged" if head == MAGIC else "the file ends early")
            return
        opcode, length = HEAD.unpack(head)
        if head.startswith(MAGIC):
            damage.add_loss(0, f"another recording begins at byte {_skip_magic(file, start)}")
        elif not _is_record(opcode, length, size - file.tell()):
            next_start = _next_start(file, start + 1, size)
            if next_start == size:
                damage.add_loss(size - start, "the file ends inside a record")
                return
            damage.add_loss(next_start - start, f"bytes {start} to {next_start} are not a record")
            file.seek(next_start)
        elif opcode == Opcode.DATA_END:
            if end.intact and file.tell() + length == end.start:
                return
            file.seek(_next_start(file, start + 1, size))  # past an index that is damaged, or of another recording
        else:
            yield from _record(file, opcode, length, damage, skipped)


def _is_record(opcode: int, length: int, left: int) -> bool:
    """Whether the head of a record, with so many bytes left behind it, can be one."""
    possible = opcode > 0 and length <= min(left, MAX_RECORD_BYTES)
    return possible and (opcode != Opcode.DATA_END or length == DATA_END_BYTES)


def _record(file: IO[bytes], opcode: int, length: int, damage: DamageReport, skipped: frozenset[int]) -> Iterator[Any]:
    if opcode in skipped:
        file.seek(length, 1)
    elif opcode == Opcode.CHUNK:
        yield from _chunk(file.read(length), damage)
    elif opcode == Opcode.MESSAGE:
        yield from _one(partial(r.Message.read, length=length), file.read(length), damage)
    elif opcode == Opcode.ATTACHMENT:
        yield from _one(partial(_attachment, data := file.read(length)), data, damage)
    elif opcode in _KINDS:
        yield from _one(_KINDS[opcode].read, file.read(length), damage)
    else:
        file.seek(length, 1)


def _skip_magic(file: IO[bytes], start: int) -> int:
    """Go on behind the magic bytes at `start`, of which a file has some at its end, too; where the last ones are."""
    at = start
    file.seek(at)
    while file.read(len(MAGIC)) == MAGIC:
        at += len(MAGIC)
    file.seek(at)
    return at - len(MAGIC)


def _next_start(file: IO[bytes], start: int, size: int) -> int:
    """Offset of the next plausible chunk, or of magic bytes, from `start` on; `size` if there is none."""
    file.seek(start)
    window, at = b"", start  # content of the file from `at` on
    while block := file.read(WINDOW_BYTES):
        window += block
        # a hole has neither: to look for single bytes takes a twentieth of the time
        for match in _START.finditer(window) if any(first in window for first in _FIRST) else ():
            if match[0] == MAGIC:
                return at + match.start()
            (length,) = struct.unpack_from("<Q", window, match.start() + 1)
            if length <= min(size - at - match.start() - HEAD.size, MAX_RECORD_BYTES):
                return at + match.start()
        at += max(len(window) - CHUNK_HEAD_BYTES, 0)
        window = window[-CHUNK_HEAD_BYTES:]
    return size


def _attachment(data: bytes, stream: ReadDataStream) -> Any:
    """An attachment; raises ValueError if its checksum, its last four bytes, is wrong."""
    crc = int.from_bytes(data[-4:], "little")
    if crc and zlib.crc32(data[:-4]) != crc:
        raise ValueError("wrong checksum")
    return r.Attachment.read(stream)


def _one(read: Any, data: bytes, damage: DamageReport) -> Iterator[Any]:
    try:
        record = read(ReadDataStream(BytesIO(data)))
    except DAMAGE as error:
        damage.add_loss(len(data), f"a record is damaged: {type(error).__name__}")
        return
    yield record


def _chunk(data: bytes, damage: DamageReport) -> Iterator[Any]:
    try:
        chunk = r.Chunk.read(ReadDataStream(BytesIO(data)))
        inside = records_of(_unpacked(chunk), chunk.uncompressed_crc)
    except DAMAGE as error:
        damage.damaged_chunks += 1
        damage.add_loss(len(data), f"a chunk is damaged: {str(error) or type(error).__name__}")
        return
    damage.chunks += 1
    yield from inside


def _unpacked(chunk: Any) -> bytes:
    """Uncompressed records of a chunk, limited to its declared size and MAX_CHUNK_BYTES."""
    declared = chunk.uncompressed_size
    if declared > MAX_CHUNK_BYTES:
        raise ValueError(f"declared size of {declared} bytes, expected at most {MAX_CHUNK_BYTES}")
    if chunk.compression == "zstd":
        plain = zstandard.ZstdDecompressor().stream_reader(BytesIO(chunk.data)).read(declared + 1)
    elif chunk.compression == "lz4":
        plain = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=declared + 1)
    elif chunk.compression == "":
        plain = chunk.data
    else:
        raise ValueError(f"unknown compression {chunk.compression!r}")
    if len(plain) != declared:
        raise ValueError(f"declared size of {declared} bytes, holds {len(plain)}")
    return bytes(plain)
