"""Counts publications that are no message of ours; bounded, whatever a stranger publishes."""

from __future__ import annotations

from collections import Counter

from tailor.schemas.errors import Rejected
from tailor.tools.status.picture import ForeignView

MAX_KEYS = 50
MAX_REASONS = 30  # of a key with their fields; after that without
OTHER_KEYS = "other keys"


class ForeignCounts:
    """Counters of foreign keys and of refused messages.

    Attributes:
      dropped: Messages that the observer's own queue dropped.
    """

    def __init__(self) -> None:
        self.dropped = 0
        self._unknown: Counter[str] = Counter()
        self._refused: dict[str, Counter[str]] = {}

    def unknown(self, key: str) -> None:
        """Count a publication under a key that no topic has."""
        known = key in self._unknown or len(self._unknown) < MAX_KEYS
        self._unknown[key if known else OTHER_KEYS] += 1

    def refused(self, key: str, reason: str, where: str = "") -> None:
        """Count a publication under a key of ours that is no valid message; `where`: in which field, if known."""
        if key not in self._refused and len(self._refused) >= MAX_KEYS:
            key = OTHER_KEYS
        counts = self._refused.setdefault(key, Counter())
        text = Rejected(reason, where).text
        counts[text if text in counts or len(counts) < MAX_REASONS else reason] += 1

    def view(self) -> ForeignView:
        """The counters as plain data."""
        refused = {key: dict(reasons) for key, reasons in self._refused.items()}
        return ForeignView(dict(self._unknown), refused, self.dropped)
