"""Few arenas for all threads: what one frees, another uses. A loop keeps the pages of what it frees."""

import ctypes
import subprocess
import sys

import pytest

SCRIPT = """
import ctypes, sys, threading
from tailor.runtime import malloc_settings

if sys.argv[1] != "none":
    getattr(malloc_settings, sys.argv[1])()
libc = ctypes.CDLL(None)
libc.malloc.restype, libc.malloc.argtypes = ctypes.c_void_p, [ctypes.c_size_t]
together = threading.Barrier(8)

def work():
    together.wait()
    for _ in range(100):
        libc.malloc(5000)
    together.wait()

threads = [threading.Thread(target=work) for _ in range(8)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
libc.malloc_stats()
"""


def arenas(how):
    done = subprocess.run([sys.executable, "-c", SCRIPT, how], capture_output=True, text=True, check=True)
    return sum(line.startswith("Arena") for line in done.stderr.splitlines())


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "malloc_stats"), reason="the C library has no arenas")
def test_threads_share_few_arenas():
    assert arenas("none") > 2
    assert arenas("set_for_host") == 1
    assert arenas("set_for_loop") == 2


ARRAYS = """
import resource, sys
import numpy as np
from tailor.runtime import malloc_settings

if sys.argv[1] != "none":
    getattr(malloc_settings, sys.argv[1])()

def faults():
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt

for number in range(20):
    before = faults()
    some = [np.ones((k, 1 << 17)) for k in (7, 7, 7)]
    del some
print(faults() - before)
"""


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "malloc_stats"), reason="the C library has no such settings")
def test_a_loop_finds_the_pages_of_arrays_that_it_has_freed():
    def faults(how):
        return int(subprocess.run([sys.executable, "-c", ARRAYS, how], capture_output=True, check=True).stdout)

    assert faults("set_for_loop") < 10 < faults("none"), "21 MB are 5400 pages, or 11 large ones"
