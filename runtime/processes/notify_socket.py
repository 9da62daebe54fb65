"""The supervisor's side of systemd's notification protocol: one datagram socket per child; see notify.py.

The kernel states which process sent a datagram. Only the child itself counts: neither its children nor another process
of the same user can report that it is ready or alive.
"""

from __future__ import annotations

import contextlib
import errno
import os
import socket
import struct
from dataclasses import dataclass
from pathlib import Path

MAX_BYTES = 4096  # of a datagram; longer ones are cut
MAX_PATH_BYTES = 107  # Linux: sun_path, without its final zero
MAX_DATAGRAMS = 64  # per poll, also during a flood
_CREDENTIALS = struct.Struct("3i")  # struct ucred: pid, uid, gid


@dataclass(frozen=True, slots=True)
class Report:
    """Everything that a child reported since the last poll."""

    ready: bool = False
    alive: bool = False
    stopping: bool = False
    status: str | None = None  # None: unchanged


class NotifySocket:
    """Socket of one child, in a folder that only this user can open."""

    def __init__(self, path: Path) -> None:
        """Create and bind the socket; `path` is new and at most MAX_PATH_BYTES long, otherwise OSError is raised."""
        self.path = path
        if len(os.fsencode(path)) > MAX_PATH_BYTES:  # the system's own error would name no file, and have no reason
            raise OSError(errno.ENAMETOOLONG, "too long for a socket, expected a shorter TMPDIR", str(path))
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_PASSCRED, 1)
        try:
            self._socket.bind(str(path))
        except OSError:
            self._socket.close()
            raise

    def poll(self, pid: int) -> Report:
        """What process `pid` reported since the last poll; never blocks. Other processes' reports are dropped."""
        report = Report()
        for _ in range(MAX_DATAGRAMS):
            try:
                data, ancillary, _, _ = self._socket.recvmsg(MAX_BYTES, socket.CMSG_SPACE(_CREDENTIALS.size))
            except OSError:  # none waits, or closed
                break
            if _sender(ancillary) == pid:
                report = _merged(report, data)
        return report

    def close(self) -> None:
        """Close and remove the socket."""
        self._socket.close()
        with contextlib.suppress(OSError):
            os.unlink(self.path)


def _sender(ancillary: list[tuple[int, int, bytes]]) -> int | None:
    for level, kind, data in ancillary:
        if level == socket.SOL_SOCKET and kind == socket.SCM_CREDENTIALS and len(data) >= _CREDENTIALS.size:
            pid: int = _CREDENTIALS.unpack_from(data)[0]
            return pid
    return None


def _merged(report: Report, data: bytes) -> Report:
    variables = dict(line.partition("=")[::2] for line in data.decode(errors="replace").splitlines())
    return Report(
        ready=report.ready or variables.get("READY") == "1",
        alive=report.alive or variables.get("WATCHDOG") == "1",
        stopping=report.stopping or variables.get("STOPPING") == "1",
        status=variables.get("STATUS", report.status),
    )
