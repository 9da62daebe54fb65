"""Attachment of every publication, 33 bytes in rmw_zenoh's layout: sequence number, source time, sender id."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from tailor.schemas.errors import Rejected

_LAYOUT = struct.Struct("<qqB16s")  # sequence, source time ns, length of the sender id, sender id
SENDER_BYTES = 16


@dataclass(frozen=True, slots=True)
class Origin:
    """Origin of a message according to its sender."""

    sequence: int  # increases by one with each message of one publisher
    source_ns: int  # sender's wall clock, Unix nanoseconds (ROS's convention); never used in a decision
    sender: str  # 32 hex digits, one id per process


UNSIGNED = Origin(0, 0, "")  # publication without attachment, e.g. from a ROS 2 bridge


def pack(origin: Origin) -> bytes:
    """Attachment of 33 bytes, little-endian."""
    return _LAYOUT.pack(origin.sequence, origin.source_ns, SENDER_BYTES, bytes.fromhex(origin.sender))


def unpack(data: bytes | None) -> Origin | Rejected:
    """Origin in an attachment: UNSIGNED for None, Rejected for a malformed one."""
    if data is None:
        return UNSIGNED
    if len(data) != _LAYOUT.size:
        return Rejected("bad attachment")
    sequence, source_ns, length, sender = _LAYOUT.unpack(data)
    if length != SENDER_BYTES:
        return Rejected("bad attachment")
    return Origin(sequence, source_ns, sender.hex())


def sender_in(data: bytes | None) -> str:
    """Sender in an attachment; empty where it states none."""
    origin = unpack(data)
    return "" if isinstance(origin, Rejected) else origin.sender
