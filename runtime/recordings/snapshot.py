"""The last seconds of the bus in memory, written out when somebody asks or something goes wrong."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from pathlib import Path

from tailor.runtime.bus.inbox import Raw
from tailor.runtime.recordings.mcap_writer import McapWriter
from tailor.schemas.codec import decode
from tailor.schemas.messages import DriverState, ExecStatus
from tailor.schemas.reason_text import reason_text
from tailor.schemas.topics import TOPICS

MAX_BYTES = 256_000_000  # of memory, whatever the time span
AFTER_NS = 1_000_000_000  # of what follows a failure goes into its file too


class SnapshotBuffer:
    """Messages of the last `span_ns`, at most `most_bytes` of them."""

    def __init__(self, span_ns: int, most_bytes: int = MAX_BYTES) -> None:
        self._span_ns, self._most_bytes = span_ns, most_bytes
        self._messages: deque[tuple[Raw, int]] = deque()
        self._bytes = 0

    def add(self, raw: Raw, wall_ns: int) -> None:
        """Keep a message that was received at `wall_ns`, and forget the oldest."""
        self._messages.append((raw, wall_ns))
        self._bytes += len(raw.payload)
        while self._messages[0][1] < wall_ns - self._span_ns or self._bytes > self._most_bytes:
            self._bytes -= len(self._messages.popleft()[0].payload)

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to write."""
        return not self._messages

    def write(self, path: Path, facts: Mapping[str, Mapping[str, str]]) -> int:
        """Write everything into a new file; how many messages.

        Raises:
          FileExistsError: There is such a file.
          OSError: The disk does not take it; then nothing is left of it.
        """
        tape = McapWriter(path, facts)
        for raw, wall_ns in self._messages:
            tape.write(raw, wall_ns)
        if not tape.close():
            path.unlink()
            raise OSError(0, tape.trouble, str(path))
        return tape.messages


class FailureDetector:
    """Notices failures in what goes by: an executive that comes into FAULT, a driver that stops by itself."""

    def __init__(self) -> None:
        self._modes: dict[str, str] = {}

    def detect(self, raw: Raw) -> str:
        """What has just gone wrong, empty if nothing."""
        if raw.key == TOPICS["status"].key:
            return self._changed(raw, decode(ExecStatus, raw.payload), ("FAULT",))
        if raw.key.endswith(TOPICS["driver"].key.removeprefix("{robot}")):
            return self._changed(raw, decode(DriverState, raw.payload), ("stopped", "estopped"))
        return ""

    def _changed(self, raw: Raw, state: object, bad: tuple[str, ...]) -> str:
        if not isinstance(state, ExecStatus | DriverState):
            return ""
        before, self._modes[raw.key] = self._modes.get(raw.key), state.mode
        if before is None or state.mode == before or state.mode not in bad:
            return ""
        cause = reason_text(state.reason, state.detail)
        return f"{raw.key}: {state.mode}: {cause}"
