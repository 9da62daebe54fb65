"""A recorder that keeps the last seconds in memory and writes them when asked or when something goes wrong."""

from __future__ import annotations

from pathlib import Path

from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.clock import wall_ns
from tailor.runtime.recordings.mcap_writer import ENCODING
from tailor.runtime.recordings.recorder import Health
from tailor.runtime.recordings.recording_metadata import RecordingMetadata
from tailor.runtime.recordings.selection import Selection
from tailor.runtime.recordings.snapshot import AFTER_NS, FailureDetector, SnapshotBuffer


class SnapshotRecorder:
    """Call `step` a few dozen times a second, `ask` to have a file written, and `close` at the end."""

    def __init__(
        self, path: Path, intake: IngestQueue, selection: Selection, buffer: SnapshotBuffer, facts: RecordingMetadata
    ) -> None:
        """Files will be NAME_000.mcap and so on beside `path`; none is made before it is needed."""
        self.health = Health()
        self._path, self._intake, self._selection = path, intake, selection
        self._ring, self._facts, self._alarm = buffer, facts, FailureDetector()
        self._reason = ""  # why a file is due
        self._write_at_ns = 0
        self._number = 0  # of the next file

    def step(self, now_ns: int) -> None:
        """Take what has arrived; write a file when one is due. `now_ns` is monotonic."""
        for raw in self._intake.drain():
            self._keep(raw, now_ns)
        self.health.drops = self._intake.drops
        if self._reason and now_ns >= self._write_at_ns:
            self._write()

    def request_snapshot(self, reason: str, now_ns: int) -> bool:
        """Have what is in memory written at the next turn; False if nothing is there yet."""
        if self._ring.is_empty:
            return False
        if not self._reason:
            self._reason, self._write_at_ns = reason, now_ns
        return True

    def close(self) -> Health:
        """Write what a failure left due; nothing else."""
        if self._reason:
            self._write()
        return self.health

    def _keep(self, raw: Raw, now_ns: int) -> None:
        if not raw.is_put or not self._selection.wants(raw.key, raw.encoding.removeprefix(ENCODING)):
            return
        self._ring.add(raw, raw.received_wall_ns or wall_ns())
        self._facts.observe(raw)
        failure = self._alarm.detect(raw)
        if failure and not self._reason:
            self._reason, self._write_at_ns = failure, now_ns + AFTER_NS  # what follows tells too

    def _write(self) -> None:
        reason, self._reason = self._reason, ""
        health, path = self.health, self._free_path()
        try:
            health.messages += self._ring.write(path, {**self._facts.entries, "snapshot": {"reason": reason}})
        except OSError as error:
            health.trouble = error.strerror or str(error)
            return
        health.files.append(path)
        health.bytes += path.stat().st_size

    def _free_path(self) -> Path:
        """The next name that no file has: those of an earlier recorder are kept."""
        while True:
            path = self._path.with_name(f"{self._path.stem}_{self._number:03d}{self._path.suffix}")
            if not path.exists():
                return path
            self._number += 1
