"""Measures how much CPU time a piece of work needs, however busy the machine is."""

import gc
import time
from collections.abc import Callable

from tailor.runtime.gc_freeze import gc_frozen

REPETITIONS = 3  # other processes evict caches, which only adds CPU time: as in timeit, the minimum is the measurement


def min_cpu_s(work: Callable[[], object]) -> float:
    """Minimum CPU time of three repetitions of `work`, in seconds; all three are always made.

    The test runner's own objects are kept out of the garbage collections that are measured with the work.
    """
    gc.collect()
    measured_s = []
    with gc_frozen():
        for _ in range(REPETITIONS):
            began_s = time.process_time()
            work()
            measured_s.append(time.process_time() - began_s)
    return min(measured_s)
