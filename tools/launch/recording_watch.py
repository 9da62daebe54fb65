"""What the launcher does when its recording ends or lacks something: it stops the run, or reports it once."""

from __future__ import annotations

from collections.abc import Callable

ENDED = "nothing is recorded any more"


class RecordingWatch:
    """Watches the recorder of one run."""

    def __init__(self, required: bool, report: Callable[[str], None]) -> None:
        """`required`: a failure of the recording ends the run; `report` receives one line per event."""
        self._required = required
        self._report = report
        self._ended = False
        self._lacking = False

    def failure(self, ended: bool, status: str) -> str:
        """Failure of the run, or "".

        Args:
          ended: Whether the recorder has ended.
          status: What the recording lacks, reported by the recorder; empty: nothing.
        """
        if ended and not self._ended:
            self._report(ENDED)
        if status and not self._lacking:
            self._report(f"the recording is incomplete: {status}")
        self._ended, self._lacking = ended, bool(status)
        if not self._required:
            return ""
        if ended:
            return "failed: the recording ended"
        return f"failed: the recording is incomplete: {status}" if status else ""
