"""Refuses to open a session where this process has too few file descriptors: zenoh's threads panic without them."""

from __future__ import annotations

import os
import resource

from tailor.schemas.errors import UsageError

# Measured with zenoh 1.10: it starts five runtimes when it needs them, of which each has three; and the connection.
CLIENT = 16
ROUTER = 18  # it listens as well, and has a client of its own
_FOLDER = "/dev/fd"  # lists those of this process, on Linux and macOS


def require_descriptors(needed: int) -> None:
    """Raise UsageError unless this process may open so many files more; where the system lists none, it may."""
    limit, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    taken = _taken(limit)
    if limit != resource.RLIM_INFINITY and limit - taken < needed:
        expected = f"expected at least {taken + needed}"
        raise UsageError(f"this process may have {limit} files and connections open (ulimit -n), {expected}")


def _taken(limit: int) -> int:
    """Descriptors in use below the limit; all if not even they can be listed."""
    if not os.path.isdir(_FOLDER):
        return 0
    try:
        listed = os.listdir(_FOLDER)
    except OSError:
        return limit
    return sum(int(number) < limit for number in listed) - 1  # one of them listed the others
