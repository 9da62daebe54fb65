"""Recorder that keeps the last seconds in memory and writes them on request or after a failure."""

from __future__ import annotations

from pathlib import Path

from tailor.runtime.bus.encoding import named_type
from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.clock import wall_ns
from tailor.runtime.recordings.recorder import Health
from tailor.runtime.recordings.recording_metadata import RecordingMetadata
from tailor.runtime.recordings.selection import Selection
from tailor.runtime.recordings.snapshot import AFTER_NS, FailureDetector, SnapshotBuffer

RETRY_NS = 2_000_000_000  # after a write that failed: people may have made room


class SnapshotRecorder:
    """Call `step` a few dozen times a second, `request_snapshot` for a file, and `close` at the end."""

    def __init__(
        self, path: Path, queue: IngestQueue, selection: Selection, buffer: SnapshotBuffer, metadata: RecordingMetadata
    ) -> None:
        """Write snapshots to NAME_000.mcap and so on beside `path`; none is created in advance."""
        self.health = Health()
        self._path, self._queue, self._selection = path, queue, selection
        self._buffer, self._metadata, self._detector = buffer, metadata, FailureDetector()
        self._reason = ""  # of the snapshot that is due; empty if none is
        self._write_at_ns = 0
        self._keep_until_ns: int | None = None  # of one whose write failed: then its first message has left the buffer
        self._number = 0  # of the next file

    def step(self, now_ns: int) -> None:
        """Buffer received messages; write a snapshot when due. `now_ns` is monotonic."""
        for raw in self._queue.drain():
            self._keep(raw, now_ns)
        self.health.drops = self._queue.drops
        if self._reason and now_ns >= self._write_at_ns:
            self._write(now_ns)

    def request_snapshot(self, reason: str, now_ns: int) -> bool:
        """Request that the next step writes a snapshot; False if the buffer is empty."""
        if self._buffer.is_empty:
            return False
        if not self._reason or self._keep_until_ns is not None:
            self._expect(reason, now_ns)
        return True

    def close(self) -> Health:
        """Write a snapshot that is due; nothing otherwise."""
        self._keep_until_ns = 0  # the last attempt
        while self._reason:  # again if another recorder takes the name
            self._write(0)
        return self.health

    def _expect(self, reason: str, at_ns: int) -> None:
        self._reason, self._write_at_ns, self._keep_until_ns = reason, at_ns, None

    def _keep(self, raw: Raw, now_ns: int) -> None:
        if not raw.is_put:
            return
        failure = self._detector.detect(raw)  # whether it is recorded or not: any selection may be of a failure
        if failure and (not self._reason or self._keep_until_ns is not None):
            self._expect(failure, now_ns + AFTER_NS)  # includes the second after the failure
        if self._selection.wants(raw.key, named_type(raw.encoding)):
            self._buffer.add(raw, raw.received_wall_ns or wall_ns(), now_ns)
            self._metadata.observe(raw)

    def _write(self, now_ns: int) -> None:
        reason, self._reason = self._reason, ""
        if self._buffer.is_empty:
            return
        health, path = self.health, self._free_path()
        try:
            health.messages += self._buffer.write(path, {**self._metadata.entries, "snapshot": {"reason": reason}})
        except FileExistsError:  # another recorder has just taken the name, e.g. for the same failure
            self._reason, self._number = reason, self._number + 1
            return
        except OSError as error:
            health.disk_error = error.strerror or str(error)
            self._try_again(reason, now_ns)
            return
        self._keep_until_ns = None
        health.disk_error = ""
        health.files.append(path)
        health.bytes += path.stat().st_size

    def _try_again(self, reason: str, now_ns: int) -> None:
        """Expect another attempt, for as long as the buffer holds what this one would have written."""
        if self._keep_until_ns is None:
            self._keep_until_ns = now_ns + self._buffer.span_ns
        if now_ns + RETRY_NS < self._keep_until_ns:
            self._reason, self._write_at_ns = reason, now_ns + RETRY_NS

    def _free_path(self) -> Path:
        """Next unused name: snapshots of an earlier recorder are kept."""
        while True:
            path = self._path.with_name(f"{self._path.stem}_{self._number:03d}{self._path.suffix}")
            if not path.exists():
                return path
            self._number += 1
