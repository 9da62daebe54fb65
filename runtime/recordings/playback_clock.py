"""Due times of recorded messages, absolute on the player's clock, so that lateness does not accumulate. Pure."""

from __future__ import annotations

MIN_RATE, MAX_RATE = 0.01, 100.0  # recorded seconds per second


class PlaybackClock:
    """Maps recorded time to the player's time; can be paused, stepped, and change its rate."""

    def __init__(self, first_ns: int, now_ns: int, rate: float = 1.0, paused: bool = False) -> None:
        """Start at the recorded time `first_ns`; `rate` is in recorded seconds per second."""
        self.rate = rate
        self._recorded_ns, self._at_ns = first_ns, now_ns  # the same moment on both clocks
        self._paused = paused
        self._steps = 0

    @property
    def paused(self) -> bool:
        """Whether recorded time is paused."""
        return self._paused

    def recorded_ns(self, now_ns: int) -> int:
        """Recorded time at `now_ns`."""
        if self._paused:
            return self._recorded_ns
        return self._recorded_ns + round((now_ns - self._at_ns) * self.rate)

    def due_ns(self, recorded_ns: int) -> int | None:
        """Time to send the message of `recorded_ns`; None while paused."""
        if self._paused:
            return None
        return self._at_ns + round((recorded_ns - self._recorded_ns) / self.rate)

    def jump(self, recorded_ns: int, now_ns: int) -> None:
        """Go on from another recorded time."""
        self._recorded_ns, self._at_ns = recorded_ns, now_ns

    def toggle(self, now_ns: int) -> None:
        """Pause or resume."""
        self._rebase(now_ns)
        self._paused = not self._paused

    def step(self) -> None:
        """Permit one message during a pause."""
        self._steps += self._paused

    def take_step(self, recorded_ns: int) -> bool:
        """Whether the message of `recorded_ns` may be sent during a pause; consumes one step."""
        if self._steps == 0:
            return False
        self._steps -= 1
        self._recorded_ns = recorded_ns
        return True

    def scale(self, factor: float, now_ns: int) -> None:
        """Multiply the rate, within MIN_RATE and MAX_RATE."""
        self._rebase(now_ns)
        self.rate = min(max(self.rate * factor, MIN_RATE), MAX_RATE)

    def _rebase(self, now_ns: int) -> None:
        self.jump(self.recorded_ns(now_ns), now_ns)
