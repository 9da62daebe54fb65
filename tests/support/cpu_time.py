"""Measures how much CPU time a piece of work needs, however busy the machine is."""

import gc
import math
import time
from collections.abc import Callable

from tailor.runtime.gc_freeze import gc_frozen

REPETITIONS = 3  # other processes evict caches, which only adds CPU time: as in timeit, the minimum is the measurement


def min_cpu_s(work: Callable[[], object], limit_s: float) -> float:
    """Minimum CPU time of three repetitions of `work`, in seconds; less than a limit that one keeps is not measured.

    The test runner's own objects are kept out of the garbage collections that are measured with the work.
    """
    gc.collect()
    least_s = math.inf
    with gc_frozen():
        for _ in range(REPETITIONS):
            began_s = time.process_time()
            work()
            least_s = min(least_s, time.process_time() - began_s)
            if least_s < limit_s:
                break
    return least_s
