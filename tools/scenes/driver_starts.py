"""Tells when a robot's driver has started anew: a simulator begins elsewhere then, so that no line leads there."""

from __future__ import annotations

from collections import deque

from tailor.schemas.messages import DriverState

KEPT = 8  # epochs of a driver; more only where several publish at once, of which none is new all the time


class DriverStarts:
    """The drivers that were heard so far."""

    def __init__(self) -> None:
        self._epochs: dict[str, deque[int]] = {}  # by key

    def is_another(self, state: DriverState, key: str = "") -> bool:
        """Whether a state is the first one of another start of the driver that publishes under a key."""
        known = self._epochs.setdefault(key, deque(maxlen=KEPT))
        if state.epoch in known:
            return False
        known.append(state.epoch)
        return len(known) > 1
