"""Locks memory, so that a tick waits for no page: what is in use is resident, what was only reserved is not.

mlockall alone makes everything resident: a BLAS buffer of 32 MB, thread stacks of 2 and 8 MB, code for other CPUs.
Call it after the warm-up, which touches what the loop will use.
"""

from __future__ import annotations

import ctypes
import errno
import os
import re
import resource
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_MCL_CURRENT, _MCL_FUTURE, _MCL_ONFAULT = 1, 2, 4  # <sys/mman.h>
SMALL_BYTES = 1_000_000  # a mapping up to this size is made resident, whatever is in use of it
LARGE_BYTES = 8_000_000  # the code of a library: the pages that the warm-up touched are enough
MIN_SHARE_IN_USE = 1 / 8  # of a mapping between them; of a thread's stack about 1 % is in use
_MAPPING = re.compile(r"([0-9a-f]+)-([0-9a-f]+) (\S{4}) \S+ \S+ \S+\s*(.*)")


@dataclass(frozen=True, slots=True)
class Mapping:
    """One mapping of this process: a range of addresses."""

    start: int
    size: int  # bytes
    resident: int  # bytes
    access: str  # as in /proc/self/maps, e.g. r-xp
    name: str  # file or [heap]; empty: anonymous

    @property
    def is_in_use(self) -> bool:
        """Whether all of it should be resident: the rest of it will be needed, too."""
        if self.access.startswith("-") or self.name.startswith(("[v", "[stack")):
            return False  # guard pages; the kernel's own; a stack grows by itself
        if self.name == "[heap]" or self.size <= SMALL_BYTES:
            return True
        return self.size <= LARGE_BYTES and self.resident >= self.size * MIN_SHARE_IN_USE


def lock_memory() -> str:
    """Lock all that is resident, make the rest of the mappings in use resident, and lock later ones as they are used.

    Later ones are not made resident at once: the bus starts threads when a connection breaks, and of each one's stack
    of 2 MB it uses some pages. The first use of a later page costs a microsecond, and never waits for a disk.

    Returns:
      "locked", or why it was refused.
    """
    soft, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    if os.geteuid() != 0 and soft != resource.RLIM_INFINITY:
        return f"not locked: limited to {soft} bytes"  # locking later pages would then fail in the middle of a run
    libc = ctypes.CDLL(None, use_errno=True)
    refused = _lock_all(libc, _MCL_CURRENT | _MCL_FUTURE | _MCL_ONFAULT)
    if refused == errno.EINVAL:  # Linux before 4.4
        refused = _lock_all(libc, _MCL_CURRENT | _MCL_FUTURE)
    elif not refused:
        refused = _lock_all(libc, _MCL_FUTURE | _MCL_ONFAULT)
        for mapping in mappings():
            if mapping.is_in_use:
                libc.mlock(ctypes.c_void_p(mapping.start), ctypes.c_size_t(mapping.size))
    return f"not locked: {os.strerror(refused)}" if refused else "locked"


def mappings() -> Iterator[Mapping]:
    """Mappings of this process."""
    found = None
    for line in Path("/proc/self/smaps").read_text().splitlines():
        if match := _MAPPING.fullmatch(line):
            found = match
        elif line.startswith("Rss:") and found is not None:
            start, end = int(found[1], 16), int(found[2], 16)
            yield Mapping(start, end - start, int(line.split()[1]) * 1024, found[3], found[4])


def _lock_all(libc: ctypes.CDLL, flags: int) -> int:
    """Error number of mlockall, 0 if it succeeded."""
    return 0 if libc.mlockall(flags) == 0 else ctypes.get_errno()
