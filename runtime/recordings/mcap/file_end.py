"""What follows the data of an MCAP file: summary, footer and magic bytes. Trusted only if the checksum is right."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import IO

from mcap.opcode import Opcode

MAGIC = b"\x89MCAP0\r\n"
BLOCK_BYTES = 1_000_000  # of a checksum: the summary of a day has 200 MB
HEAD = struct.Struct("<BQ")  # opcode, length
_FOOTER = struct.Struct("<BQQQI")  # opcode, length, start of the summary, start of its offsets, checksum
_CRC_BYTES = 4


@dataclass(frozen=True, slots=True)
class FileEnd:
    """Where the data must end if the footer belongs to this file."""

    start: int = -1  # of the summary, or of the footer if there is no summary; -1: the file has no footer
    footer: int = -1
    intact: bool = False  # the checksum is right, or there is none

    def declarations(self, file: IO[bytes]) -> Iterator[tuple[int, bytes]]:
        """Schemas and channels of an intact summary: the chunk that declares them may be damaged."""
        file.seek(max(self.start, 0))
        while self.intact and file.tell() < self.footer:
            opcode, length = HEAD.unpack(file.read(HEAD.size))
            if opcode not in (Opcode.SCHEMA, Opcode.CHANNEL) or length > self.footer - file.tell():
                return
            yield opcode, file.read(length)


def read_end(file: IO[bytes], size: int) -> FileEnd:
    """Read the footer, and compare the checksum of the summary."""
    footer = size - _FOOTER.size - len(MAGIC)
    if footer < len(MAGIC):
        return FileEnd()
    file.seek(footer)
    opcode, length, start, _, crc = _FOOTER.unpack(file.read(_FOOTER.size))
    if opcode != Opcode.FOOTER or length != _FOOTER.size - HEAD.size or file.read() != MAGIC:
        return FileEnd()
    if not start:
        return FileEnd(footer, footer, True)
    if not len(MAGIC) <= start <= footer:
        return FileEnd()
    return FileEnd(start, footer, not crc or crc == _checksum(file, start, footer + _FOOTER.size - _CRC_BYTES))


def _checksum(file: IO[bytes], start: int, end: int) -> int:
    file.seek(start)
    crc = 0
    while block := file.read(min(BLOCK_BYTES, end - file.tell())):
        crc = zlib.crc32(block, crc)
    return crc
