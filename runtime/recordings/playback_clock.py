"""When a recorded message is due again: absolute times on the player's clock, so that lateness never adds up. Pure."""

from __future__ import annotations

SLOWEST, FASTEST = 0.01, 100.0


class PlaybackClock:
    """Maps recorded time to the player's; can be paused, stepped, and change its rate on the way."""

    def __init__(self, first_ns: int, now_ns: int, rate: float = 1.0, paused: bool = False) -> None:
        """Recorded time `first_ns` is now; `rate` is recorded seconds per second."""
        self.rate = rate
        self._recorded_ns, self._at_ns = first_ns, now_ns  # two names of one moment
        self._paused = paused
        self._steps = 0

    @property
    def paused(self) -> bool:
        """Whether time stands still."""
        return self._paused

    def recorded_ns(self, now_ns: int) -> int:
        """The recorded time that it is now."""
        if self._paused:
            return self._recorded_ns
        return self._recorded_ns + round((now_ns - self._at_ns) * self.rate)

    def due_ns(self, recorded_ns: int) -> int | None:
        """When a message of `recorded_ns` is to be sent; None while paused."""
        if self._paused:
            return None
        return self._at_ns + round((recorded_ns - self._recorded_ns) / self.rate)

    def toggle(self, now_ns: int) -> None:
        """Pause, or go on from where it was paused."""
        self._rebase(now_ns)
        self._paused = not self._paused

    def step(self) -> None:
        """Let one message pass a pause."""
        self._steps += self._paused

    def take_step(self, recorded_ns: int) -> bool:
        """Whether a paused player may send the message of `recorded_ns` now; uses up one step."""
        if self._steps == 0:
            return False
        self._steps -= 1
        self._recorded_ns = recorded_ns
        return True

    def scale(self, factor: float, now_ns: int) -> None:
        """Go faster or slower from now on, within SLOWEST and FASTEST."""
        self._rebase(now_ns)
        self.rate = min(max(self.rate * factor, SLOWEST), FASTEST)

    def _rebase(self, now_ns: int) -> None:
        self._recorded_ns, self._at_ns = self.recorded_ns(now_ns), now_ns
