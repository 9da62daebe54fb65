"""The search of a decision, as far as it has been reported, while its messages are read."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from tailor.schemas.messages import RefinementReport, TickReport

LATE_TICKS = 8  # by which the report of a tick may come later than that of its search


@dataclass(slots=True)
class RecordedSearch:
    """Reports of one search, of which the last counts, and the ticks that it took.

    Attributes:
      report: The last report.
      ticks: Number of its ticks.
      deliberation_s: Deliberation time in these ticks, as far as they have been reported.
    """

    report: RefinementReport | None = None
    ticks: int = 0
    deliberation_s: float = 0.0
    _unreported: set[int] = field(default_factory=set)

    def adds(self, report: RefinementReport, tick: TickReport | None) -> bool:
        """Take a report of the same search, and the newest report of a tick; False if it is of another search."""
        last = self.report
        if last is not None and _certifies(report, last):
            self.report = replace(report, tick=last.tick)  # the search's last tick
            return True
        if last is not None and report.checks <= last.checks:
            return False
        self.report = report
        if last is None or report.tick != last.tick:
            self.ticks += 1
            self._unreported = {each for each in self._unreported if each > report.tick - LATE_TICKS} | {report.tick}
        if tick is not None:
            self.note(tick)
        return True

    def note(self, report: TickReport) -> None:
        """Add the deliberation time of a tick, if it is one of the search."""
        if report.tick in self._unreported:
            self._unreported.remove(report.tick)
            self.deliberation_s += max(0, report.work_ns - report.control_ns) / 1e9

    def so_far(self) -> RecordedSearch:
        """A copy, which counts no further report of the search, but those of the ticks until now."""
        return replace(self, _unreported=set(self._unreported))


def _certifies(report: RefinementReport, last: RefinementReport) -> bool:
    """Whether a report adds only a certificate to the last one of the same search."""
    same = (report.evaluations, report.checks, report.best_s) == (last.evaluations, last.checks, last.best_s)
    return same and report.gap_pct >= 0
