"""No child outlives this process: one small process kills those that survive the death signal; see end_orphans.py."""

from __future__ import annotations

import atexit
import contextlib
import os
import socket
import subprocess
import sys
from functools import cache
from pathlib import Path

END_S = 0.5  # for the watching process to end, at the end of this one
_SCRIPT = str(Path(__file__).with_name("end_orphans.py"))


def kill_if_orphaned(pid: int) -> None:
    """Have a child killed that still runs a few seconds after the death of this process."""
    _watch().add(pid)


class _OrphanWatch:
    """The watching process, and this process's end of the socket pair."""

    def __init__(self) -> None:
        self._channel, theirs = socket.socketpair()
        try:
            self._process = _watching(theirs)
        except OSError:
            self._channel.close()
            raise
        atexit.register(self.close)

    def add(self, pid: int) -> None:
        child = os.pidfd_open(pid)  # names this very process, also after its pid is used again
        try:
            with contextlib.suppress(BrokenPipeError):  # killed by hand: the death signal remains
                socket.send_fds(self._channel, [b"c"], [child])
        finally:
            os.close(child)

    def close(self) -> None:
        self._channel.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(END_S)


def _watching(channel: socket.socket) -> subprocess.Popen[bytes]:
    """The watching process, to which this end of the socket pair passes."""
    with channel:
        return subprocess.Popen(
            [sys.executable, "-I", "-S", _SCRIPT, str(channel.fileno())],
            pass_fds=[channel.fileno()],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,  # it may outlive this process, whose readers wait for the end of its output
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )


@cache
def _watch() -> _OrphanWatch:
    return _OrphanWatch()
