"""Few arenas of malloc for all threads of a process on the bus.

The C library gives threads arenas of their own, up to eight for each CPU, and an arena does not use what was freed in
another. The bus starts threads when connections break: a launcher's memory grew by 4.1 MB over seven interruptions of
2 s, with one arena by 1.0 MB; an executive's by 0.28 MB over five, with two arenas by 0.13 MB. Threads may wait for
one another in malloc, so a real-time loop keeps a second arena beside the first.
"""

from __future__ import annotations

import ctypes

HOST = 1  # arenas of a process that hosts the bus and has no deadline
LOOP = 2  # of one with a real-time loop
_M_ARENA_MAX = -8  # <malloc.h> of the GNU C library


def limit_arenas(count: int) -> bool:
    """Call it before threads start; False if the C library is not GNU's."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    return mallopt is not None and mallopt(_M_ARENA_MAX, count) == 1
