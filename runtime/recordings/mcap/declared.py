"""Schemas and channels that a file declares, within limits: a chunk of some kB may unpack to 60 MB of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mcap import records as r

from tailor.schemas.errors import UsageError

MAX_BYTES = 64_000_000  # in a file; 10 000 channels of ours have 3 MB


class Declared:
    """The schemas and channels in force, by their numbers in the file."""

    def __init__(self, path: Path) -> None:
        """`path` is the file in errors."""
        self.schemas: dict[int, Any] = {0: None}
        self.channels: dict[int, Any] = {}
        self._path = path
        self._bytes = 0  # also of those that others have replaced: a reader may keep them

    def add(self, record: Any) -> bool:
        """Note a schema or a channel; False if it is known already: each chunk may repeat it.

        Raises:
          UsageError: The file declares more than MAX_BYTES.
        """
        known = self.schemas if isinstance(record, r.Schema) else self.channels
        if known.get(record.id) == record:
            return False
        self._bytes += _size(record)
        if self._bytes > MAX_BYTES:
            raise UsageError(f"{self._path}: more than {MAX_BYTES} bytes of schemas and channels, expected less")
        known[record.id] = record
        return True


def _size(record: Any) -> int:
    if isinstance(record, r.Schema):
        return len(record.name) + len(record.encoding) + len(record.data)
    texts = (record.topic, record.message_encoding, *record.metadata, *record.metadata.values())
    return sum(map(len, texts))
