"""A process reports to its supervisor: ready, alive, stopping, status. The protocol is systemd's sd_notify(3).

Each report is one datagram to the socket that the environment names, so that `tailor up` and systemd supervise the
same way. A report never blocks and never raises: a supervisor that does not read cannot delay a tick.
"""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Callable, MutableMapping

SOCKET_VARIABLE = "NOTIFY_SOCKET"
ALIVE_PERIOD_S = 0.05  # faster loops report no more often; half of the shortest period that is supervised
MAX_STATUS = 200  # characters; a line of a terminal


class Notifier:
    """Reports of this process; without a socket it does nothing."""

    def __init__(self, address: str, clock: Callable[[], float] = time.monotonic) -> None:
        """`address`: path of the socket, or `@` and an abstract name; empty: none. `clock`: monotonic seconds."""
        self._address = f"\0{address[1:]}" if address.startswith("@") else address
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) if address else None
        if self._socket is not None:
            self._socket.setblocking(False)
        self._clock = clock
        self._alive_at_s = -ALIVE_PERIOD_S
        self._unsent: dict[str, str] = {}  # variables whose datagram the supervisor's full queue refused

    @property
    def supervised(self) -> bool:
        """Whether a supervisor takes the reports."""
        return self._socket is not None

    @classmethod
    def from_environment(cls, environment: MutableMapping[str, str] = os.environ) -> Notifier:
        """Notifier to the socket of NOTIFY_SOCKET, which is removed: no child of this process may report for it."""
        return cls(environment.pop(SOCKET_VARIABLE, ""))

    def ready(self) -> None:
        """Start-up is complete."""
        self._send({"READY": "1"})

    def alive(self) -> None:
        """The main loop turns. Call it from that loop alone, never from a thread: it is the watchdog's food."""
        now_s = self._clock()
        if now_s - self._alive_at_s >= ALIVE_PERIOD_S:
            self._alive_at_s = now_s
            self._send({"WATCHDOG": "1"})

    def stopping(self) -> None:
        """The process ends on its own account or on request."""
        self._send({"STOPPING": "1"})

    def status(self, text: str) -> None:
        """State of the process for people, one line; empty: nothing to report any more."""
        self._send({"STATUS": " ".join(text.split())[:MAX_STATUS]})

    def _send(self, variables: dict[str, str]) -> None:
        if self._socket is None:
            return
        self._unsent.update(variables)
        lines = "\n".join(f"{name}={value}" for name, value in self._unsent.items())
        try:
            self._socket.sendto(lines.encode(errors="replace"), self._address)
        except OSError:  # nobody reads: the next report repeats this one
            return
        self._unsent.clear()


SILENT = Notifier("")  # of a process without supervisor
