"""Records inside an unpacked chunk of an MCAP file; there are thousands, so they are read directly."""

from __future__ import annotations

import struct
import zlib
from io import BytesIO
from typing import Any

from mcap import records as r
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode

_HEAD = struct.Struct("<BQ")  # opcode, length
_MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time; then the data
_OTHERS: dict[int, Any] = {Opcode.SCHEMA: r.Schema, Opcode.CHANNEL: r.Channel}


def records_of(plain: bytes, crc: int) -> list[Any]:
    """Schemas, channels and messages in file order; other records are skipped.

    Args:
      plain: Uncompressed content of the chunk.
      crc: CRC-32 from the head of the chunk; 0 if unknown.

    Raises:
      ValueError: The content is damaged; `struct.error` and errors of mcap mean damage, too.
    """
    if crc and zlib.crc32(plain) != crc:
        raise ValueError("wrong checksum")
    records: list[Any] = []
    at = 0
    while at < len(plain):
        opcode, length = _HEAD.unpack_from(plain, at)
        start, at = at + _HEAD.size, at + _HEAD.size + length
        if at > len(plain):
            raise ValueError("a record exceeds the end of the chunk")
        if opcode == Opcode.MESSAGE:
            records.append(_message(plain, start, at))
        elif opcode in _OTHERS:
            records.append(_OTHERS[opcode].read(ReadDataStream(BytesIO(plain[start:at]))))
    return records


def _message(plain: bytes, start: int, end: int) -> Any:
    if end - start < _MESSAGE.size:
        raise ValueError("a message is shorter than its head")
    channel, sequence, log_ns, publish_ns = _MESSAGE.unpack_from(plain, start)
    return r.Message(channel, log_ns, plain[start + _MESSAGE.size : end], publish_ns, sequence)
