"""Snapshots: the last seconds of the bus in memory, and the failures that trigger writing them."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Mapping
from pathlib import Path

from tailor.runtime.bus.attachment import sender_in
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import count_key, memory_of
from tailor.runtime.newest import Newest
from tailor.runtime.recordings.mcap.channel_table import MAX_KEYS
from tailor.runtime.recordings.mcap.writer import McapWriter
from tailor.schemas.codec import decode
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.reason_text import reason_text
from tailor.schemas.topics import TOPICS

MAX_BYTES = 256_000_000  # of memory, for any time span
AFTER_NS = 1_000_000_000  # a snapshot includes the second after the failure


class SnapshotBuffer:
    """Ring buffer of the messages of the last `span_ns`, at most `max_bytes`."""

    def __init__(self, span_ns: int, max_bytes: int = MAX_BYTES) -> None:
        self.span_ns = span_ns
        self._max_bytes = max_bytes
        self._messages: deque[tuple[Raw, int, int]] = deque()  # with its wall and monotonic time
        self._bytes = 0

    def add(self, raw: Raw, wall_ns: int, now_ns: int) -> None:
        """Append a message received at `wall_ns` and drop the oldest ones; `now_ns` is monotonic."""
        self._messages.append((raw, wall_ns, now_ns))
        self._bytes += memory_of(raw)
        while self._messages and (self._messages[0][2] < now_ns - self.span_ns or self._bytes > self._max_bytes):
            self._bytes -= memory_of(self._messages.popleft()[0])

    @property
    def is_empty(self) -> bool:
        """Whether the buffer holds no message."""
        return not self._messages

    def write(self, path: Path, metadata: Mapping[str, Mapping[str, str]]) -> int:
        """Write all messages into a new file; returns their number.

        Raises:
          FileExistsError: The file exists.
          OSError: Writing fails; the file is then removed.
        """
        writer = McapWriter(path, metadata)
        drops: Counter[str] = Counter()  # messages of more keys than a file may have
        for raw, wall_ns, _ in self._messages:
            if not writer.write(raw, wall_ns):
                count_key(drops, raw.key)
        if drops:
            writer.add_metadata("drops", {key: str(count) for key, count in sorted(drops.items())})
        if not writer.close():
            path.unlink()
            raise OSError(0, writer.disk_error, str(path))
        return writer.messages


class FailureDetector:
    """Detects failures in messages: an executive that enters FAULT, a driver that stops by itself."""

    def __init__(self) -> None:
        self._modes: Newest[tuple[str, str], str] = Newest(MAX_KEYS)  # by key and sender

    def detect(self, raw: Raw) -> str:
        """Description of a new failure, empty if there is none."""
        if raw.key == TOPICS["status"].key:
            return self._changed(raw, decode(ExecStatus, raw.payload), ("FAULT",))
        if raw.key.endswith(TOPICS["driver"].key.removeprefix("{robot}")):
            return self._changed(raw, decode(DriverState, raw.payload), ("stopped", "estopped"))
        return ""

    def _changed(self, raw: Raw, state: object, bad: tuple[str, ...]) -> str:
        if not isinstance(state, ExecStatus | DriverState):
            return ""
        # Two executives, or drivers of one robot, are in modes of their own: one of them in FAULT is no failure again.
        before = self._modes.renew((raw.key, sender_in(raw.attachment)), state.mode)
        if before is None or state.mode == before or state.mode not in bad:
            return ""
        cause = reason_text(state.reason, state.detail)
        return f"{raw.key}: {state.mode}: {cause}"
