"""numpy's store of freed blocks, in a process of its own: this one's is already part full."""

import ctypes
import subprocess
import sys

import pytest

SCRIPT = """
import ctypes
import numpy as np
from tailor.runtime import numpy_blocks

class MallInfo(ctypes.Structure):
    _fields_ = [("fields", ctypes.c_size_t * 10)]

libc = ctypes.CDLL(None)
libc.mallinfo2.restype = MallInfo

def given_out():
    return libc.mallinfo2().fields[7]

empty = given_out()
numpy_blocks.fill()
full = given_out()
for size in range(1, 2048):
    arrays = [np.zeros(size, bool) for _ in range(20)]
    del arrays
print(full - empty, given_out() - full)
"""


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "mallinfo2"), reason="not the GNU C library, or one before 2.33")
def test_arrays_of_any_size_take_no_more_memory_once_the_store_is_full():
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    filled_bytes, later_bytes = map(int, done.stdout.split())
    assert filled_bytes > 3_000_000
    assert later_bytes < 500_000  # malloc's own store of small blocks: 0.24 MB
