"""A session of a bus on which nobody publishes."""

from __future__ import annotations

from tailor.runtime.bus.ingest_queue import IngestQueue


class SilentSession:
    """Connected for ever; it is its own subscription."""

    connected = True

    def subscribe_all(self, pattern: str) -> tuple[IngestQueue, SilentSession]:
        """A queue in which nothing arrives."""
        return IngestQueue(), self

    def undeclare(self) -> None:
        """Nothing to undo."""
