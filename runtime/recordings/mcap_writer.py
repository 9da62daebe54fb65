"""Writes one MCAP file: ROS 2 profile, one channel per key and sender, readable up to the last flush.

Foxglove, PlotJuggler, rerun and rosbags read it. log_time is the wall time of reception, publish_time that of sending.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, IndexType, Writer

from tailor.runtime.bus.attachment import UNSIGNED, Origin, unpack
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.sink import Sink
from tailor.schemas.errors import Rejected
from tailor.schemas.topics import TOPICS
from tailor.schemas.typesystem import definition, ros_type, type_hash, type_of

CHUNK_BYTES = 131_072  # small enough that a damaged chunk loses little, large enough to compress well
# For small files that are read from front to back: one chunk, no index, no repeated records. Half the size.
COMPACT = {"chunk_size": 8_000_000, "index_types": IndexType.NONE, "repeat_channels": False, "repeat_schemas": False}
STUCK_BYTES = 16_000_000  # of data waiting for the disk; then messages are dropped
ENCODING = "application/cdr;"


class McapWriter:
    """Writes messages in the order of their reception."""

    def __init__(self, path: Path, metadata: Mapping[str, Mapping[str, str]], compact: bool = False) -> None:
        """Create the file.

        Args:
          path: New file.
          metadata: First metadata records, name -> entries.
          compact: Write one chunk without index.

        Raises:
          FileExistsError: The file exists.
          OSError: The file cannot be created.
        """
        self.path = path
        self.messages = 0
        self.first_ns: int | None = None  # log time of the first message
        self.disk_error = ""  # of the last flush; empty after a successful one
        self._sink = Sink(path)
        target: Any = self._sink
        layout: dict[str, Any] = COMPACT if compact else {"chunk_size": CHUNK_BYTES}
        self._writer: Any = Writer(target, compression=CompressionType.ZSTD, **layout)
        self._writer.start(profile="ros2", library="tailor")
        self._schemas: dict[str, int] = {}
        self._channels: dict[tuple[str, str, str], int] = {}
        for name, entries in {"topics": _topics_table(), **metadata}.items():
            self.add_metadata(name, entries)

    @property
    def is_full(self) -> bool:
        """Whether so much data waits for the disk that messages must be dropped."""
        return self._sink.pending > STUCK_BYTES

    @property
    def bytes(self) -> int:
        """Size of the file in bytes, including data that waits for the disk."""
        return self._sink.tell()

    def write(self, raw: Raw, wall_ns: int) -> None:
        """Add a message received at `wall_ns`; one with a malformed attachment counts as unsigned."""
        unpacked = unpack(raw.attachment)
        origin: Origin = UNSIGNED if isinstance(unpacked, Rejected) else unpacked
        self._writer.add_message(
            channel_id=self._channel(raw, origin.sender),
            log_time=wall_ns,
            publish_time=origin.source_ns if origin.source_ns > 0 else wall_ns,
            sequence=origin.sequence & 0xFFFFFFFF,  # MCAP has 32 bits: 13 years at 10 Hz
            data=raw.payload,
        )
        self.messages += 1
        self.first_ns = wall_ns if self.first_ns is None else self.first_ns

    def add_metadata(self, name: str, entries: Mapping[str, str]) -> None:
        """Add a metadata record; the last one of a name is valid."""
        self._writer.add_metadata(name, dict(entries))

    def flush(self) -> bool:
        """Write all messages to the disk, as complete chunks; False (and `disk_error`) if writing fails."""
        try:
            self._writer.flush()
        except OSError as error:
            self.disk_error = error.strerror or str(error)
            return False
        self.disk_error = ""
        return True

    def close(self) -> bool:
        """Write index and footer; False if writing fails, the file is then readable without them."""
        self._writer.finish()
        done = self.flush()
        self._sink.close()
        return done

    def _channel(self, raw: Raw, sender: str) -> int:
        ros_name = raw.encoding.removeprefix(ENCODING) if raw.encoding.startswith(ENCODING) else _type_by_key(raw.key)
        identity = (raw.key, sender, ros_name)
        if identity not in self._channels:
            kind: type | None = type_of(ros_name)
            entries = {"key": raw.key, "sender": sender} | ({"type_hash": type_hash(kind)} if kind else {})
            schema = self._schema(ros_name)
            self._channels[identity] = self._writer.register_channel(f"/{raw.key}", "cdr", schema, entries)
        return self._channels[identity]

    def _schema(self, ros_name: str) -> int:
        """Id of the schema of a type; 0 (none) for a type of another project."""
        kind: type | None = type_of(ros_name)
        if kind is None:
            return 0
        if ros_name not in self._schemas:
            self._schemas[ros_name] = self._writer.register_schema(ros_name, "ros2msg", definition(kind).encode())
        return self._schemas[ros_name]


def _type_by_key(key: str) -> str:
    """ROS type of a key according to the table of topics, for senders that do not name it."""
    robot, _, _ = key.partition("/")
    return next((ros_type(t.type) for t in TOPICS.values() if t.key.format(robot=robot) == key), "")


def _topics_table() -> dict[str, str]:
    return {name: json.dumps((t.key, t.type.__name__, t.rate_hz, t.fresh_s)) for name, t in TOPICS.items()}
