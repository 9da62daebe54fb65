"""What the loop uses is resident and locked; what was only reserved takes no memory."""

import json
import subprocess
import sys

import pytest

from tailor.runtime.memory_lock import Mapping

MB = 1_000_000


@pytest.mark.parametrize(
    ("size", "resident", "access", "name", "whole"),
    [
        (39 * MB, 37 * MB, "rw-p", "[heap]", True),
        (33 * MB, 0, "rw-p", "", False),  # OpenBLAS's buffer
        (8 * MB, 12_000, "rw-p", "", False),  # a thread's stack
        (2 * MB, 1_800_000, "rw-p", "", True),  # objects of Python
        (1 * MB, 0, "rw-p", "", True),
        (24 * MB, 15 * MB, "r-xp", "/lib/onnxruntime.so", False),
        (7 * MB, 3 * MB, "r-xp", "/lib/umath.so", True),
        (3 * MB, 250_000, "r-xp", "/lib/libgfortran.so", False),
        (4096, 0, "---p", "", False),
        (64 * MB, 0, "---p", "", False),
        (8192, 4096, "r-xp", "[vdso]", False),
        (152_000, 152_000, "rw-p", "[stack]", False),
    ],
)
def test_a_mapping_in_use_is_made_resident_and_a_reserve_is_not(size, resident, access, name, whole):
    assert Mapping(0, size, resident, access, name).is_in_use is whole


LOCKED = """
import json, mmap, re
from pathlib import Path
from tailor.runtime.memory_lock import lock_memory, mappings
reserve, used = mmap.mmap(-1, 40_000_000), mmap.mmap(-1, 4_000_000)
used.write(bytes(1_000_000))
def locked():
    return int(re.search(r"VmLck:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1]) * 1024
granted = lock_memory()
before = locked()
later = mmap.mmap(-1, 3_000_000)
later.write(bytes(999_424))
sizes = [(each.size, each.resident) for each in mappings() if each.size > 2_900_000]
print(json.dumps([granted, sizes, locked() - before]))
"""


def test_a_reserve_stays_untouched_and_what_comes_later_is_locked_as_it_is_used():
    done = subprocess.run([sys.executable, "-P", "-c", LOCKED], capture_output=True, text=True, check=True)
    granted, sizes, later = json.loads(done.stdout)
    if granted != "locked":
        pytest.skip(f"locking memory is {granted}")

    def resident(size):
        pages = -(-size // 4096) * 4096
        return [found for total, found in sizes if total == pages]

    assert resident(40_000_000) == [0]
    assert resident(4_000_000) == [4_001_792]
    assert resident(3_000_000) == [999_424]  # a whole number of pages
    assert later >= 3_000_000
