"""One MCAP file that is being written: ROS 2 profile, one channel per key and sender, readable up to the last flush.

Foxglove, PlotJuggler, rerun and rosbags open it. log_time is the wall time of reception, publish_time the sender's.
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

CHUNK_BYTES = 131_072  # a damaged chunk loses little, and a chunk still compresses well
# Of a small file that is read from front to back: one chunk, no index, nothing said twice. Half the size
COMPACT = {"chunk_size": 8_000_000, "index_types": IndexType.NONE, "repeat_channels": False, "repeat_schemas": False}
STUCK_BYTES = 16_000_000  # waiting for the disk; more is not taken
ENCODING = "application/cdr;"


class McapWriter:
    """Takes messages in the order of their reception."""

    def __init__(self, path: Path, facts: Mapping[str, Mapping[str, str]], compact: bool = False) -> None:
        """Create the file; `facts` become its first metadata records, name -> entries."""
        self.path = path
        self.messages = 0
        self.first_ns: int | None = None  # log time of the first message
        self.trouble = ""  # why the last flush failed
        self._sink = Sink(path)
        target: Any = self._sink
        layout: dict[str, Any] = COMPACT if compact else {"chunk_size": CHUNK_BYTES}
        self._writer: Any = Writer(target, compression=CompressionType.ZSTD, **layout)
        self._writer.start(profile="ros2", library="tailor")
        self._schemas: dict[str, int] = {}
        self._channels: dict[tuple[str, str, str], int] = {}
        for name, entries in {"topics": _topics_table(), **facts}.items():
            self.note(name, entries)

    @property
    def stuck(self) -> bool:
        """Whether so much waits for the disk that messages must be dropped."""
        return self._sink.pending > STUCK_BYTES

    @property
    def bytes(self) -> int:
        """Size of the file, with what waits for the disk."""
        return self._sink.tell()

    def write(self, raw: Raw, wall_ns: int) -> None:
        """Add a message that was received at `wall_ns`; one with a broken attachment counts as unsigned."""
        read = unpack(raw.attachment)
        origin: Origin = UNSIGNED if isinstance(read, Rejected) else read
        self._writer.add_message(
            channel_id=self._channel(raw, origin.sender),
            log_time=wall_ns,
            publish_time=origin.source_ns if origin.source_ns > 0 else wall_ns,
            sequence=origin.sequence & 0xFFFFFFFF,  # MCAP has 32 bits: 13 years at 10 Hz
            data=raw.payload,
        )
        self.messages += 1
        self.first_ns = wall_ns if self.first_ns is None else self.first_ns

    def note(self, name: str, entries: Mapping[str, str]) -> None:
        """Add a metadata record; the last one of a name holds."""
        self._writer.add_metadata(name, dict(entries))

    def flush(self) -> bool:
        """Put everything so far on the disk, as whole chunks; False (and `trouble`) if the disk refuses."""
        try:
            self._writer.flush()
        except OSError as error:
            self.trouble = error.strerror or str(error)
            return False
        self.trouble = ""
        return True

    def close(self) -> bool:
        """Write index and footer; False if the disk refuses, the file is then readable without them."""
        self._writer.finish()
        done = self.flush()
        self._sink.close()
        return done

    def _channel(self, raw: Raw, sender: str) -> int:
        ros_name = raw.encoding.removeprefix(ENCODING) if raw.encoding.startswith(ENCODING) else _type_by_key(raw.key)
        place = (raw.key, sender, ros_name)
        if place not in self._channels:
            kind = type_of(ros_name)
            entries = {"key": raw.key, "sender": sender} | ({"type_hash": type_hash(kind)} if kind else {})
            schema = self._schema(ros_name)
            self._channels[place] = self._writer.register_channel(f"/{raw.key}", "cdr", schema, entries)
        return self._channels[place]

    def _schema(self, ros_name: str) -> int:
        """Id of a type's schema; 0 (none) for a type that is not ours."""
        kind = type_of(ros_name)
        if kind is None:
            return 0
        if ros_name not in self._schemas:
            self._schemas[ros_name] = self._writer.register_schema(ros_name, "ros2msg", definition(kind).encode())
        return self._schemas[ros_name]


def _type_by_key(key: str) -> str:
    """The ROS type that the topics table gives a key of any robot, for senders that name none."""
    robot, _, _ = key.partition("/")
    return next((ros_type(t.type) for t in TOPICS.values() if t.key.format(robot=robot) == key), "")


def _topics_table() -> dict[str, str]:
    rows = {name: (t.key, t.type.__name__, t.rate_hz, t.fresh_s) for name, t in TOPICS.items()}
    return {name: json.dumps(row) for name, row in rows.items()}
