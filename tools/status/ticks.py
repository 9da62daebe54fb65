"""Timing of an executive's ticks over the last minute. Pure."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from tailor.schemas.messages import TickReport
from tailor.tools.status.picture import Spread, TickTimes

WINDOW_NS = 60_000_000_000
KEPT = 1200  # twice what a minute has at 10 Hz; a forged flood must not grow this process


class TickTimer:
    """Tick reports of one executive."""

    def __init__(self) -> None:
        self._ticks: deque[tuple[int, int, int, int]] = deque(maxlen=KEPT)  # arrival, work, lateness, skipped

    def add(self, now_ns: int, report: TickReport) -> None:
        """Record a report that arrived at `now_ns`."""
        self._ticks.append((now_ns, report.work_ns, report.lateness_ns, report.skipped))

    def times(self, now_ns: int) -> TickTimes | None:
        """Timing of the ticks reported within the last minute; None without any."""
        recent = [tick for tick in self._ticks if tick[0] > now_ns - WINDOW_NS]
        if not recent:
            return None
        _, work_ns, lateness_ns, skipped = zip(*recent, strict=True)
        return TickTimes(len(recent), sum(skipped), spread_ms(work_ns), spread_ms(lateness_ns))


def spread_ms(durations_ns: Sequence[int]) -> Spread:
    """Median, 99th percentile and maximum by nearest rank; at least one duration."""
    ordered = sorted(durations_ns)
    p50, p99 = (ordered[-(-len(ordered) * percent // 100) - 1] for percent in (50, 99))
    return Spread(*(round(value / 1e6, 3) for value in (p50, p99, ordered[-1])))
