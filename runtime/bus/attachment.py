"""The 33 bytes that go with every publication: who sent it, as which number, and when (rmw_zenoh's layout)."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from tailor.schemas.errors import Rejected

_LAYOUT = struct.Struct("<qqB16s")  # sequence, source time ns, length of the sender id, sender id
SENDER_BYTES = 16


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a message comes from, as its sender says."""

    sequence: int  # rises by one with each message of one publisher
    source_ns: int  # sender's wall clock, Unix nanoseconds (ROS's convention); decides nothing
    sender: str  # 32 hex digits, one per process


UNSIGNED = Origin(0, 0, "")  # what a publication without attachment has, e.g. from a ROS 2 bridge


def pack(origin: Origin) -> bytes:
    """The attachment's 33 bytes, little-endian."""
    return _LAYOUT.pack(origin.sequence, origin.source_ns, SENDER_BYTES, bytes.fromhex(origin.sender))


def unpack(data: bytes | None) -> Origin | Rejected:
    """The origin in an attachment; None (no attachment) is UNSIGNED, other lengths are refused."""
    if data is None:
        return UNSIGNED
    if len(data) != _LAYOUT.size:
        return Rejected("bad attachment")
    sequence, source_ns, length, sender = _LAYOUT.unpack(data)
    if length != SENDER_BYTES:
        return Rejected("bad attachment")
    return Origin(sequence, source_ns, sender.hex())
