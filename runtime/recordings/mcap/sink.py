"""Append-only file with atomic flushes: a flush that fails is undone and repeated with the next one.

A BackgroundSink never waits for the disk: a thread writes, and what it cannot write yet stays in memory.
"""

from __future__ import annotations

import errno
import os
import time
from contextlib import suppress
from pathlib import Path
from threading import Thread

SLOW_S = 3.0  # of one flush; then it is reported
FINISH_S = 3.0  # limit of the last flush: a stopped process ends within 5 s
SLOW = "a write takes longer than 3 s"


class Sink:
    """Target of mcap's Writer; buffers bytes until `flush` writes all of them or none."""

    def __init__(self, path: Path) -> None:
        """Create the file; raises FileExistsError if it exists."""
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644)
        self._pending = bytearray()
        self.on_disk = 0  # bytes

    @property
    def pending(self) -> int:
        """Number of buffered bytes."""
        return len(self._pending)

    def write(self, data: bytes) -> int:
        """Buffer bytes; never writes to the disk."""
        self._pending += data
        return len(data)

    def tell(self) -> int:
        """Position after the last buffered byte."""
        return self.on_disk + len(self._pending)

    def flush(self) -> None:
        """Write all buffered bytes to the disk.

        Raises:
          OSError: The disk is full or broken; the bytes stay buffered, the file is unchanged unless it cannot be cut.
        """
        try:
            os.lseek(self._file, self.on_disk, os.SEEK_SET)  # whatever a flush that failed has left behind
            done = 0
            with memoryview(self._pending) as whole:  # released at once: a buffer that is exported cannot grow
                while done < len(whole):
                    with whole[done:] as rest:
                        done += os.write(self._file, rest)
        except OSError:
            with suppress(OSError):  # of a broken disk; the next flush writes over what is left
                os.ftruncate(self._file, self.on_disk)
            raise
        self.on_disk += len(self._pending)
        self._pending = bytearray()

    def finish(self) -> None:
        """Write all buffered bytes; raises OSError like `flush`."""
        self.flush()

    @property
    def is_slow(self) -> bool:
        """Whether a flush runs for too long; never, since `flush` waits."""
        return False

    def close(self) -> None:
        """Close the file; buffered bytes are lost."""
        self._pending = bytearray()
        os.close(self._file)


class BackgroundSink(Sink):
    """A Sink whose errors appear one flush later; call it from one thread."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._newer = bytearray()  # bytes that the running thread does not write
        self._end = 0  # position after the last buffered byte, whatever the thread does meanwhile
        self._thread: Thread | None = None
        self._error: OSError | None = None  # of the last thread
        self._began_s = 0.0

    @property
    def pending(self) -> int:
        """Number of bytes that are not on the disk."""
        return self._end - self.on_disk

    @property
    def is_slow(self) -> bool:
        """Whether the running flush takes longer than SLOW_S."""
        return self._is_writing and time.monotonic() - self._began_s > SLOW_S

    def write(self, data: bytes) -> int:
        """Buffer bytes; never writes to the disk."""
        self._newer += data
        self._end += len(data)
        return len(data)

    def tell(self) -> int:
        """Position after the last buffered byte."""
        return self._end

    def flush(self) -> None:
        """Begin to write all buffered bytes, unless the previous flush still runs.

        Raises:
          OSError: The previous flush has failed; this one repeats it.
        """
        if self._is_writing:
            return
        error, self._error = self._error, None
        self._start()
        if error is not None:
            raise error

    def finish(self) -> None:
        """Write all buffered bytes and wait for it.

        Raises:
          OSError: The disk is full or broken, or does not respond within FINISH_S.
        """
        ends_s = time.monotonic() + FINISH_S
        for last in (False, True):
            if self._thread is not None:
                self._thread.join(max(ends_s - time.monotonic(), 0.0))
            if self._is_writing:
                raise OSError(errno.ETIMEDOUT, SLOW)
            if not last:
                self._error = None
                self._start()
        if self._error is not None:
            raise self._error

    def close(self) -> None:
        """Close the file, unless a write hangs; buffered bytes are lost."""
        self._end = self.on_disk
        if not self._is_writing:
            super().close()

    @property
    def _is_writing(self) -> bool:
        return self._thread is not None and self._thread.is_alive()

    def _start(self) -> None:
        self._pending += self._newer
        self._newer = bytearray()
        if self._pending:
            self._began_s = time.monotonic()
            self._thread = Thread(target=self._write, name="disk", daemon=True)
            self._thread.start()

    def _write(self) -> None:
        before = self.on_disk
        try:
            super().flush()
            # The kernel begins to write at once, not after the usual 30 s, which a power cut would lose; nobody waits.
            os.posix_fadvise(self._file, before, self.on_disk - before, os.POSIX_FADV_DONTNEED)
        except OSError as error:
            self._error = error
