"""Append-only file with atomic flushes: a flush that fails is undone and repeated with the next one."""

from __future__ import annotations

import os
from pathlib import Path


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
          OSError: The disk is full or broken; the file is unchanged, and the bytes stay buffered.
        """
        try:
            done = 0
            while done < len(self._pending):
                done += os.write(self._file, memoryview(self._pending)[done:])
        except OSError:
            os.ftruncate(self._file, self.on_disk)
            os.lseek(self._file, self.on_disk, os.SEEK_SET)
            raise
        self.on_disk += len(self._pending)
        self._pending = bytearray()

    def close(self) -> None:
        """Close the file; buffered bytes are lost."""
        os.close(self._file)
