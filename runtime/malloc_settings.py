"""Settings of malloc for a process on the bus: few arenas for all threads, and memory of large blocks given back.

The C library gives threads arenas of their own, up to eight for each CPU, and an arena does not use what was freed in
another. The bus starts threads when connections break: a launcher's memory grew by 4.1 MB over seven interruptions of
2 s, with one arena by 1.0 MB; an executive's by 0.28 MB over five, with two arenas by 0.13 MB. Threads may wait for
one another in malloc, so a real-time loop keeps a second arena beside the first.

Buffers of connections, of 64 kB each, split an arena where they were freed: a launcher grew in steps of 1.2 MB at its
second or third interruption. With mappings of their own for blocks of 32 kB and more it grew by 0.1 MB over seven. A
mapping costs a call of the kernel and page faults: again nothing for a loop. That keeps what it has once had: proofs
about networks request and free arrays of megabytes, and with the defaults each of these came as fresh pages, 15 900
page faults in a minute of soccer instead of 260, for 10 MB less.
"""

from __future__ import annotations

import ctypes

LARGE_BYTES = 32_768
KEPT_BYTES = 32 * 1024 * 1024  # the most that malloc takes as the size from which a block has a mapping of its own
_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD, _M_ARENA_MAX = -1, -3, -8  # <malloc.h> of the GNU C library


def set_for_host() -> bool:
    """Settings of a process that hosts the bus; call it before threads start. False if the C library is not GNU's."""
    return _set(_M_ARENA_MAX, 1) and _set(_M_MMAP_THRESHOLD, LARGE_BYTES)


def set_for_loop() -> bool:
    """Settings of a process with a real-time loop; see `set_for_host`."""
    kept = _set(_M_MMAP_THRESHOLD, KEPT_BYTES) and _set(_M_TRIM_THRESHOLD, KEPT_BYTES)
    return kept and _set(_M_ARENA_MAX, 2)


def _set(option: int, value: int) -> bool:
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    return mallopt is not None and mallopt(option, value) == 1
