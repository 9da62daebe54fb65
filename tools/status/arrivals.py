"""Arrivals of one topic: age, measured rate and number of senders. Pure: every call receives the time."""

from __future__ import annotations

from collections import deque

from tailor.runtime.newest import Newest

WINDOW_NS = 5_000_000_000
KEPT = 512  # arrivals; the fastest topic has 250 in the window
SENDER_NS = 1_000_000_000  # a sender that is silent for longer no longer counts
MAX_SENDERS = 64  # remembered; a flood of ids must not grow this process


class Arrivals:
    """Recent arrivals under one key.

    Attributes:
      count: Messages received so far.
    """

    def __init__(self) -> None:
        self.count = 0
        self._times: deque[int] = deque(maxlen=KEPT)
        self._senders: Newest[str, int] = Newest(MAX_SENDERS)

    def add(self, now_ns: int, sender: str) -> None:
        """Record an arrival."""
        self.count += 1
        self._times.append(now_ns)
        self._senders.renew(sender, now_ns)

    def age_s(self, now_ns: int) -> float:
        """Seconds since the last arrival; there must have been one."""
        return max(0, now_ns - self._times[-1]) / 1e9

    def rate_hz(self, now_ns: int) -> float | None:
        """Mean rate of the arrivals of the last 5 s; 0 if there are none, None if there is only one so far."""
        recent = [at_ns for at_ns in self._times if at_ns > now_ns - WINDOW_NS]
        if len(recent) < 2:
            return None if self.count == 1 else 0.0
        span_ns = recent[-1] - recent[0]
        return (len(recent) - 1) / (span_ns / 1e9) if span_ns > 0 else None

    def senders(self, now_ns: int) -> int:
        """Number of senders heard within the last second."""
        return sum(now_ns - at_ns <= SENDER_NS for at_ns in self._senders.values())
