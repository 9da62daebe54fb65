"""Identifies the executive started by this process among others on the bus, live or replayed."""

from __future__ import annotations

from tailor.schemas.messages import ExecStatus, Sample


class OwnExecutive:
    """The first new sender of `exec/status` after a start is the own executive; all other senders are foreign."""

    def __init__(self) -> None:
        self._pid = 0
        self._sender = ""
        self._senders: set[str] = set()  # of any status so far

    def sent(self, sample: Sample, pid: int) -> bool:
        """Whether a sample of an executive comes from the one that runs as process `pid`."""
        if pid != self._pid:
            self._pid, self._sender = pid, ""
        if isinstance(sample.message, ExecStatus):
            if not self._sender and sample.sender not in self._senders:
                self._sender = sample.sender
            self._senders.add(sample.sender)
        return bool(self._sender) and sample.sender == self._sender
