"""Which executive on the bus is the one that was started here: others may be there, or a recording of one be played."""

from __future__ import annotations

from tailor.schemas.messages import ExecStatus, Sample


class OwnExecutive:
    """The first new sender of `exec/status` after a start; whoever speaks besides it, or spoke before, is another."""

    def __init__(self) -> None:
        self._pid = 0
        self._sender = ""
        self._known: set[str] = set()  # every sender of a status so far

    def sent(self, sample: Sample, pid: int) -> bool:
        """Whether a sample that is not the driver's comes from the executive that runs as process `pid`."""
        if pid != self._pid:
            self._pid, self._sender = pid, ""
        if isinstance(sample.message, ExecStatus):
            if not self._sender and sample.sender not in self._known:
                self._sender = sample.sender
            self._known.add(sample.sender)
        return bool(self._sender) and sample.sender == self._sender
