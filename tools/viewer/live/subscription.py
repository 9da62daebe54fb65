"""What one page is still to receive."""

from __future__ import annotations

from queue import Empty, Full, Queue

MAX_WAITING = 64  # batches that a page may lag behind, about six seconds


class Subscription:
    """Queue of batches for one page."""

    def __init__(self, kept: str) -> None:
        self.lost = False
        self._waiting: Queue[str] = Queue(MAX_WAITING)
        self._waiting.put(kept)

    def put(self, batch: str) -> None:
        """Add a batch; a full queue marks the page as lost."""
        try:
            self._waiting.put_nowait(batch)
        except Full:
            self.lost = True

    def close(self) -> None:
        """Mark the page as lost and wake its reader."""
        self.lost = True
        self.put("[]")

    def next(self, timeout_s: float) -> str | None:
        """The next batch, a JSON array of events; None after the timeout."""
        try:
            return self._waiting.get(timeout=timeout_s)
        except Empty:
            return None
