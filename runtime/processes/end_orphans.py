"""Script that kills the children of a dead process which the death signal did not end.

Usage: `python end_orphans.py FD`. FD is one end of a socket pair; through the other end the parent sends a pidfd of
each of its children. At the death of the parent, also after kill -9, the kernel closes that end. The children have
received SIGTERM by then (parent_death_signal.py); those that still run after TERM_S are killed: stopped ones, and those
that ignore it.
"""

import os
import select
import signal
import socket
import sys
import time
from contextlib import suppress

TERM_S = 3.0  # as Child.stop grants


def main() -> None:
    """Collect pidfds until the parent dies, then wait and kill."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # systemd sends them to all processes of a service at once
    channel, children = socket.socket(fileno=int(sys.argv[1])), list[int]()
    while True:
        try:
            data, received, _, _ = socket.recv_fds(channel, 1, 1)
        except OSError:
            data, received = b"", []
        children = running([*children, *received])
        if not data:
            break
    deadline_s = time.monotonic() + TERM_S
    while children and time.monotonic() < deadline_s:
        select.select(children, [], [], max(0.0, deadline_s - time.monotonic()))
        children = running(children)
    for child in children:
        with suppress(ProcessLookupError):  # it has just ended; the others have not
            signal.pidfd_send_signal(child, signal.SIGKILL)


def running(children: list[int]) -> list[int]:
    """Those that have not ended; a pidfd is readable from the end of its process on. Closes the others."""
    ended, _, _ = select.select(children, [], [], 0)
    for child in ended:
        os.close(child)
    return [child for child in children if child not in ended]


if __name__ == "__main__":
    main()
