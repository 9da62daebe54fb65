"""Periodic loop on absolute deadlines: no drift; an overrun skips whole periods and keeps the phase."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.runtime.clock import Clock


@dataclass(frozen=True, slots=True)
class Period:
    """Start of one period; times in nanoseconds of the loop's clock."""

    deadline_ns: int  # planned start
    now_ns: int  # actual start
    skipped: int  # whole periods lost since the previous one

    @property
    def lateness_ns(self) -> int:
        """Delay of the actual start after the deadline."""
        return self.now_ns - self.deadline_ns


class Loop:
    """Starts periods at `start + k * period`."""

    def __init__(self, period_ns: int, clock: Clock) -> None:
        """Raise ValueError unless `period_ns` is positive."""
        if period_ns <= 0:
            raise ValueError(f"period_ns must be positive, is {period_ns}")
        self.period_ns = period_ns
        self._clock = clock
        self._deadline_ns: int | None = None

    def wait_for_next_period(self) -> Period:
        """Sleep until the next deadline; the first period starts at once and sets the phase."""
        now_ns = self._clock.now_ns()
        if self._deadline_ns is None:
            self._deadline_ns = now_ns
            return Period(now_ns, now_ns, 0)
        due_ns = self._deadline_ns + self.period_ns
        lost = max(0, (now_ns - due_ns) // self.period_ns)
        self._deadline_ns = due_ns + lost * self.period_ns
        self._clock.sleep_until(self._deadline_ns)
        return Period(self._deadline_ns, self._clock.now_ns(), lost)
