"""A periodic loop on absolute deadlines: it does not drift, and an overrun loses whole periods but keeps the phase."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.runtime.clock import Clock


@dataclass(frozen=True, slots=True)
class Period:
    """The start of one period."""

    deadline_ns: int  # when it should have started
    now_ns: int  # when it did
    skipped: int  # whole periods lost since the turn before

    @property
    def lateness_ns(self) -> int:
        """How long after its deadline the turn started."""
        return self.now_ns - self.deadline_ns


class Loop:
    """Hands out turns at `start + k * period`; counts what it had to skip."""

    def __init__(self, period_ns: int, clock: Clock) -> None:
        if period_ns <= 0:
            raise ValueError(f"period_ns must be positive, is {period_ns}")
        self.period_ns = period_ns
        self.overruns = 0  # turns that began after at least one whole lost period
        self.skipped = 0  # all periods lost so far
        self._clock = clock
        self._deadline_ns: int | None = None

    def wait_for_next_period(self) -> Period:
        """Wait for the next deadline; the first turn starts at once and sets the phase."""
        now_ns = self._clock.now_ns()
        if self._deadline_ns is None:
            self._deadline_ns = now_ns
            return Period(now_ns, now_ns, 0)
        due_ns = self._deadline_ns + self.period_ns
        lost = max(0, (now_ns - due_ns) // self.period_ns)
        self._deadline_ns = due_ns + lost * self.period_ns
        self.skipped += lost
        self.overruns += lost > 0
        self._clock.sleep_until(self._deadline_ns)
        return Period(self._deadline_ns, self._clock.now_ns(), lost)
