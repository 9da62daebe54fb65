"""Stamps of commands: they only refuse. Standard library alone; pure.

The clocks of sender and driver need not agree: what counts is the distance from stamp to arrival, compared with the
least one since arming. Clocks drift apart; a distance that grows no faster than they do is no delay.
"""

from __future__ import annotations

from tailor.simnodes.reasons import CommandRefusal

MAX_DELAY_NS = 300_000_000  # beyond the fastest command since arming
MAX_AHEAD_NS = 100_000_000  # below it: stamped in the future
SETTLED = 10  # commands since arming, after which the fastest one is known well enough to call others too fast
DRIFT_PPM = 100  # of two quartz clocks; 0.36 s in an hour


class Stamps:
    """Stamps of one sender since it was armed."""

    def __init__(self) -> None:
        """No command yet."""
        self._count = 0
        self._fastest_ns = 0  # distance of the fastest command, and when it came
        self._fastest_at_ns = 0

    def refusal(self, now_ns: int, stamp_ns: int) -> CommandRefusal | None:
        """Reason for refusing a command.

        Args:
          now_ns: Monotonic time of its arrival.
          stamp_ns: Time of its creation by the sender's clock; 0: unknown, it is not judged.
        """
        if not stamp_ns or not self._count:
            return None
        distance_ns = now_ns - stamp_ns
        if distance_ns > self._expected_ns(now_ns) + MAX_DELAY_NS:
            return CommandRefusal.LATE
        if distance_ns < self._fastest_ns - MAX_AHEAD_NS and self._count >= SETTLED:
            return CommandRefusal.FROM_THE_FUTURE
        return None

    def accept(self, now_ns: int, stamp_ns: int) -> None:
        """Take account of an accepted command."""
        if not stamp_ns:
            return
        if not self._count or now_ns - stamp_ns <= self._expected_ns(now_ns):
            self._fastest_ns, self._fastest_at_ns = now_ns - stamp_ns, now_ns
        self._count += 1

    def _expected_ns(self, now_ns: int) -> int:
        """Distance of a command as fast as the fastest one, if the clocks have drifted apart since."""
        return self._fastest_ns + max(0, now_ns - self._fastest_at_ns) * DRIFT_PPM // 1_000_000
