"""Reads recordings: messages in the order of reception, metadata, and a report of the damage."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mcap import records as r

from tailor.runtime.recordings.mcap.channel_table import Declaration
from tailor.runtime.recordings.mcap.declared import Declared
from tailor.runtime.recordings.mcap.scan import DamageReport, scan
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected, UsageError
from tailor.schemas.messages import Message
from tailor.schemas.typesystem import definition, hash_of_definition, type_hash, type_of

_SENDER = re.compile(r"[0-9a-f]{32}")
CDR = "cdr"  # encoding of the messages of ROS 2
LATEST_NS = 2**63 - 1  # of a sender's clock: int64 on the bus
UNDECLARED = Declaration(0, "", "", None, ())


@dataclass(frozen=True, slots=True)
class Recorded:
    """One message of a recording."""

    key: str  # on the bus, e.g. agilo/odom
    ros_type: str  # empty if unknown, or if it is none of ROS 2
    sender: str  # 32 hex digits, empty if unsigned
    sequence: int
    log_ns: int  # wall time of reception
    publish_ns: int  # sender's wall time
    data: bytes  # CDR
    declared: Declaration = field(default=UNDECLARED, compare=False, repr=False)  # its channel

    def value(self) -> Message | Rejected | None:
        """What its bytes mean; None of a type that Tailor does not have."""
        kind = type_of(self.ros_type)
        return None if kind is None else decode(kind, self.data)


class Recording:
    """MCAP file on disk; every call reads it again, so that any size fits into memory."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.damage = DamageReport()  # of the last complete iteration over messages()

    def messages(self) -> Iterator[Recorded]:
        """All messages in file order, which is the order of reception; damaged parts are skipped, see `damage`."""
        declared = Declared(self.path)
        channels: dict[int, tuple[str, str, str, Declaration]] = {}
        self.damage = DamageReport()
        for record in scan(self.path, self.damage):
            if isinstance(record, r.Message):
                if record.channel_id in channels:
                    yield _recorded(record, *channels[record.channel_id])
            elif isinstance(record, r.Schema):
                declared.add(record)
            elif isinstance(record, r.Channel):
                declared.add(record)
                schema = declared.schemas.get(record.schema_id)
                name = "" if schema is None else schema.name
                if record.message_encoding == CDR:
                    self._check_schema(record, schema)
                elif type_of(name) is not None:
                    name = ""  # JSON, for instance, of the same name: nothing that Tailor reads
                key = record.metadata.get("key") or record.topic.strip("/")
                sender = record.metadata.get("sender", "")
                declaration = _declaration(record, schema)
                channels[record.id] = (key, name, sender if _SENDER.fullmatch(sender) else "", declaration)

    def decoded(self, kinds: Collection[type] | None = None) -> Iterator[tuple[Recorded, Message | Rejected]]:
        """Messages of these types, by default of all that Tailor has, with their values; others are skipped."""
        for recorded in self.messages():
            kind = type_of(recorded.ros_type)
            if kind is not None and (kinds is None or kind in kinds):
                yield recorded, decode(kind, recorded.data)

    def metadata(self) -> list[tuple[str, dict[str, str]]]:
        """Metadata records (name, entries) in file order; of several with one name, the last is valid."""
        records = scan(self.path, DamageReport(), with_chunks=False)
        return [(record.name, record.metadata) for record in records if isinstance(record, r.Metadata)]

    def _check_schema(self, channel: Any, schema: Any) -> None:
        """Raise UsageError if one of Tailor's types has changed since the recording."""
        kind: type | None = type_of(schema.name) if schema is not None else None
        if kind is None:
            return
        recorded, today = channel.metadata.get("type_hash"), type_hash(kind)
        if recorded is None:
            if schema.encoding != "ros2msg":
                problem = f"defined in {schema.encoding!r}" if schema.encoding else "not defined"
                raise UsageError(f"{self.path}: {schema.name} is {problem}, expected its definition in 'ros2msg'")
            text = schema.data.decode(errors="replace")
            if _normalized(text) == _normalized(definition(kind)):
                return
            recorded = hash_of_definition(schema.name, text)
        if recorded != today:
            raise UsageError(
                f"{self.path}: {schema.name} has changed since this was recorded, expected {type_hash(kind)[:20]}…"
            )


def open_recording(path: str | Path) -> Recording:
    """Open a recording.

    Raises:
      UsageError: The file is missing, or not an MCAP file.
    """
    recording = Recording(Path(path))
    next(scan(recording.path, DamageReport(), with_chunks=False), None)
    return recording


def _declaration(channel: Any, schema: Any) -> Declaration:
    declared = None if schema is None else (schema.name, schema.encoding, schema.data)
    return Declaration(channel.id, channel.topic, channel.message_encoding, declared, tuple(channel.metadata.items()))


def _recorded(record: Any, key: str, name: str, sender: str, declared: Declaration) -> Recorded:
    publish_ns = min(record.publish_time, LATEST_NS)
    return Recorded(key, name, sender, record.sequence, record.log_time, publish_ns, record.data, declared)


def _normalized(text: str) -> str:
    """Definition without comments and extra spaces; other recorders keep them differently."""
    lines = (" ".join(line.split("#")[0].split()) for line in text.splitlines())
    return "\n".join(line for line in lines if line)
