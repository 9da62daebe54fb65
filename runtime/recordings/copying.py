"""Copies recordings of any origin record by record: all messages, or selected ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mcap import records as r
from mcap.writer import CompressionType, Writer

from tailor.runtime.recordings.mcap.declared import Declared
from tailor.runtime.recordings.mcap.scan import DamageReport, scan
from tailor.runtime.recordings.mcap.writer import CHUNK_BYTES
from tailor.runtime.recordings.new_file import new_file

PROFILE = "ros2"
MAX_CHANNELS = 65_535  # their numbers have 16 bits
Keep = Callable[[str, str, int], bool]  # key, ROS type, log time (ns)


@dataclass(slots=True)
class CopyResult:
    """Counts of a copy."""

    kept: int = 0
    left_out: int = 0
    attachments: int = 0
    damage: DamageReport = field(default_factory=DamageReport)  # of the source


class _Copy:
    """Renumbers schemas and channels, and writes only those that have messages."""

    def __init__(self, writer: Any, declared: Declared) -> None:
        self.writer, self.declared = writer, declared
        self._new_schemas: dict[tuple[str, str, bytes], int] = {}
        self._new_channels: dict[tuple[int, str, str, int, tuple[tuple[str, str], ...]], int] = {}
        self._copies: dict[int, int] = {}  # number of a channel in force -> that of its copy

    def declare(self, record: Any) -> None:
        """Note a schema or a channel; a file of several recordings gives their numbers to others."""
        if not self.declared.add(record):
            return
        if isinstance(record, r.Schema):
            self._copies.clear()
        else:
            self._copies.pop(record.id, None)

    def origin(self, record: Any) -> tuple[str, str] | None:
        """Key and ROS type of a message; None if the record of its channel is lost."""
        channel = self.declared.channels.get(record.channel_id)
        if channel is None:
            return None
        schema = self.declared.schemas.get(channel.schema_id)
        return channel.metadata.get("key") or channel.topic.strip("/"), "" if schema is None else schema.name

    def write(self, record: Any) -> bool:
        """Copy one message; False if the new file has no room for its channel."""
        copied = self._copies.get(record.channel_id)
        if copied is None:
            copied = self._channel(self.declared.channels[record.channel_id])
            if copied is None:
                return False
            self._copies[record.channel_id] = copied
        self.writer.add_message(copied, record.log_time, record.data, record.publish_time, record.sequence)
        return True

    def _channel(self, channel: Any) -> int | None:
        """Number of the copy of a channel; None if the new file has no room for it."""
        schema = self._schema(self.declared.schemas.get(channel.schema_id))
        identity = (channel.id, channel.topic, channel.message_encoding, schema, tuple(channel.metadata.items()))
        if identity not in self._new_channels:
            if len(self._new_channels) == MAX_CHANNELS:
                return None
            new = self.writer.register_channel(channel.topic, channel.message_encoding, schema, channel.metadata)
            self._new_channels[identity] = new
        return self._new_channels[identity]

    def _schema(self, schema: Any) -> int:
        if schema is None:
            return 0
        identity = (schema.name, schema.encoding, schema.data)
        if identity not in self._new_schemas:
            self._new_schemas[identity] = self.writer.register_schema(*identity)
        return self._new_schemas[identity]


def copy(
    source: Path, target: Path, keep: Keep, note: Mapping[str, str], attachments_alone: bool = False
) -> CopyResult:
    """Copy the messages that `keep` selects, all metadata and attachments, into a new file with index and footer.

    Where nothing is kept there is no new file: it would hold metadata alone, and be in the way of the next attempt.

    Args:
      source: MCAP file, damaged or not.
      target: New file.
      keep: Predicate of key, ROS type and log time in ns.
      note: Entries of the metadata record "copy".
      attachments_alone: Whether attachments without any message are worth a file.

    Raises:
      UsageError: The source is missing or no MCAP file, or the target exists or cannot be written and is removed.
    """
    copied = CopyResult()
    profile = _profile(source)  # checks the source before the target is created
    with new_file(target), target.open("xb") as file:
        writer: Any = Writer(file, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
        writer.start(profile=profile, library="tailor")
        _copy_records(source, _Copy(writer, Declared(source)), keep, copied)
        writer.add_metadata("copy", {"of": utf8_name(source), "damage": copied.damage.text(), **note})
        writer.finish()
        if not (copied.kept or (attachments_alone and copied.attachments)):
            target.unlink()
    return copied


def utf8_name(path: Path) -> str:
    """Name of a file; "?" stands for bytes that are no UTF-8, which metadata cannot hold."""
    return path.name.encode(errors="replace").decode()


def _profile(source: Path) -> str:
    """What a recording states of its messages; of one whose head is damaged, that of ours."""
    heads = (record for record in scan(source, DamageReport(), with_chunks=False) if isinstance(record, r.Header))
    return next((head.profile for head in heads), PROFILE)


def _copy_records(source: Path, copy_: _Copy, keep: Keep, copied: CopyResult) -> None:
    for record in scan(source, copied.damage, with_attachments=True):
        if isinstance(record, r.Schema | r.Channel):
            copy_.declare(record)
        elif isinstance(record, r.Metadata):
            copy_.writer.add_metadata(record.name, record.metadata)
        elif isinstance(record, r.Attachment):
            copied.attachments += 1
            copy_.writer.add_attachment(
                record.create_time, record.log_time, record.name, record.media_type, record.data
            )
        elif isinstance(record, r.Message):
            origin = copy_.origin(record)
            if origin is not None and keep(*origin, record.log_time) and copy_.write(record):
                copied.kept += 1
            else:
                copied.left_out += 1
