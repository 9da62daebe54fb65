"""A file that grows by whole blocks: a write that fails half-way leaves no trace, and is tried again next time."""

from __future__ import annotations

import os
from pathlib import Path


class Sink:
    """What mcap's Writer writes to. Bytes gather in memory until `flush` puts them on disk, all or none."""

    def __init__(self, path: Path) -> None:
        """Create the file; refuses to overwrite one (FileExistsError)."""
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644)
        self._pending = bytearray()
        self.on_disk = 0  # bytes

    @property
    def pending(self) -> int:
        """Bytes that wait for the disk."""
        return len(self._pending)

    def write(self, data: bytes) -> int:
        """Take bytes; never touches the disk."""
        self._pending += data
        return len(data)

    def tell(self) -> int:
        """Position after everything taken so far."""
        return self.on_disk + len(self._pending)

    def flush(self) -> None:
        """Put what waits on the disk.

        Raises:
          OSError: The disk is full or broken; the file is as it was before, and the bytes still wait.
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
        """Close the file; what still waits is lost."""
        os.close(self._file)
