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
    """Schemas, channels and messages in their order; other kinds are left out.

    Args:
      plain: What the chunk holds, uncompressed.
      crc: Its CRC-32 by the chunk's head; 0: not known.

    Raises:
      ValueError: It is not what was written. `struct.error` and mcap's own errors tell of damage, too.
    """
    if crc and zlib.crc32(plain) != crc:
        raise ValueError("its checksum is wrong")
    found: list[Any] = []
    at = 0
    while at < len(plain):
        opcode, length = _HEAD.unpack_from(plain, at)
        start, at = at + _HEAD.size, at + _HEAD.size + length
        if at > len(plain):
            raise ValueError("a record in it goes beyond its end")
        if opcode == Opcode.MESSAGE:
            found.append(_message(plain, start, at))
        elif opcode in _OTHERS:
            found.append(_OTHERS[opcode].read(ReadDataStream(BytesIO(plain[start:at]))))
    return found


def _message(plain: bytes, start: int, end: int) -> Any:
    if end - start < _MESSAGE.size:
        raise ValueError("a message in it has no room for its head")
    channel, sequence, log_ns, publish_ns = _MESSAGE.unpack_from(plain, start)
    return r.Message(channel, log_ns, plain[start + _MESSAGE.size : end], publish_ns, sequence)
