"""Writes one MCAP file: ROS 2 profile, one channel per key and sender, readable up to the last flush.

Foxglove, PlotJuggler, rerun and rosbags read it. log_time is the wall time of reception, publish_time that of sending.
"""

from __future__ import annotations

import json
from collections import Counter, deque
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, IndexType, Writer

from tailor.runtime.bus.attachment import UNSIGNED, Origin, unpack
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap.channel_table import ChannelTable, Declaration
from tailor.runtime.recordings.mcap.chunk_index_spool import ChunkIndexSpool
from tailor.runtime.recordings.mcap.sink import SLOW, BackgroundSink, Sink
from tailor.schemas.errors import Rejected
from tailor.schemas.topics import TOPICS

CHUNK_BYTES = 131_072  # small enough that a damaged chunk loses little, large enough to compress well
# For small files that are read from front to back: one chunk, no index, no repeated records. Half the size.
COMPACT = {"chunk_size": 8_000_000, "index_types": IndexType.NONE, "repeat_channels": False, "repeat_schemas": False}
Sent = tuple[int, bytes, int, int]  # log time (ns), data, publish time (ns), sequence
STUCK_BYTES = 16_000_000  # of data waiting for the disk; then messages are dropped


class McapWriter:
    """Writes messages in the order of their reception."""

    def __init__(
        self, path: Path, metadata: Mapping[str, Mapping[str, str]], compact: bool = False, background: bool = False
    ) -> None:
        """Create the file.

        Args:
          path: New file.
          metadata: First metadata records, name -> entries.
          compact: Write one chunk without index.
          background: Flush without waiting for the disk.

        Raises:
          FileExistsError: The file exists.
          OSError: The file cannot be created.
        """
        self.path = path
        self.messages = 0  # once closed: those that are on the disk
        self.unwritten = 0  # lost as the file was closed
        self.disk_error = ""  # of the last flush; empty after a successful one
        self._sink = BackgroundSink(path) if background else Sink(path)
        self._ends: deque[tuple[int, int]] = deque()  # (position, messages before it) that may not be on the disk yet
        self._written = 0  # messages before the last position that was on the disk
        target: Any = self._sink
        layout: dict[str, Any] = COMPACT if compact else {"chunk_size": CHUNK_BYTES}
        self._writer: Any = Writer(target, compression=CompressionType.ZSTD, **layout)
        self._writer.start(profile="ros2", library="tailor")
        self._index = ChunkIndexSpool(path.parent)
        self._index.install(self._writer)
        self._channels = ChannelTable(self._writer)
        for name, entries in {"topics": _topics_table(), **metadata}.items():
            self.add_metadata(name, entries)

    @property
    def is_full(self) -> bool:
        """Whether so much data waits for the disk that messages must be dropped."""
        return self._sink.pending > STUCK_BYTES

    @property
    def bytes(self) -> int:
        """Size of the file in bytes, including data that waits for the disk; once closed without."""
        return self._sink.tell()

    @property
    def mixed(self) -> Counter[str]:
        """Number of messages whose sender is not recorded, by key: it has too many of them."""
        return self._channels.mixed

    def write(self, raw: Raw, wall_ns: int) -> bool:
        """Add a message received at `wall_ns`; one with a malformed attachment counts as unsigned.

        Returns:
          False if the file has too many keys for this one; the message is then not recorded.
        """
        unpacked = unpack(raw.attachment)
        origin: Origin = UNSIGNED if isinstance(unpacked, Rejected) else unpacked
        channel = self._channels.channel(raw, origin.sender)
        publish_ns = origin.source_ns if origin.source_ns > 0 else wall_ns
        sequence = origin.sequence & 0xFFFFFFFF  # MCAP has 32 bits: 13 years at 10 Hz
        return self._add(channel, (wall_ns, raw.payload, publish_ns, sequence))

    def copy(self, key: str, declared: Declaration, sent: Sent) -> bool:
        """Add a message of another file, its channel declared as there.

        Returns:
          False if the file has too many keys for this one; the message is then not recorded.
        """
        return self._add(self._channels.copied(key, declared), sent)

    def _add(self, channel: int | None, sent: Sent) -> bool:
        if channel is None:
            return False
        self._writer.add_message(channel, *sent)
        self.messages += 1
        return True

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
        finally:
            self._mark_end()
        self.disk_error = SLOW if self._sink.is_slow else ""
        return not self.disk_error

    def close(self) -> bool:
        """Write index and footer; False if writing fails, the file is then readable without them."""
        self._writer.finish()
        self._mark_end()
        try:
            self._sink.finish()
            self.disk_error = ""
        except OSError as error:
            self.disk_error = error.strerror or str(error)
        self._index.close()
        self._sink.close()
        self.unwritten = self.messages - self._count_written()
        self.messages -= self.unwritten
        return not self.disk_error

    def _mark_end(self) -> None:
        """All messages so far end here: they are in complete chunks."""
        self._count_written()
        if self.messages > (self._ends[-1][1] if self._ends else self._written):
            self._ends.append((self._sink.tell(), self.messages))

    def _count_written(self) -> int:
        while self._ends and self._ends[0][0] <= self._sink.on_disk:
            self._written = self._ends.popleft()[1]
        return self._written


def _topics_table() -> dict[str, str]:
    return {name: json.dumps((t.key, t.type.__name__, t.rate_hz, t.fresh_s)) for name, t in TOPICS.items()}
