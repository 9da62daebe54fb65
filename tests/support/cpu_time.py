"""How much of a processor a piece of work needs, however busy the machine that measures it."""

import gc
import time
from collections.abc import Callable

from tailor.runtime.gc_freeze import gc_frozen

TRIES = 3  # what other processes take from the caches only ever adds: the least of several tries is the nearest


def least_cpu_s(work: Callable[[], object], enough_s: float) -> float:
    """The least CPU seconds of up to three tries; the first below `enough_s` ends it.

    The test runner's own objects are kept out of the garbage collections that are measured with the work.
    """
    gc.collect()
    least_s = float("inf")
    with gc_frozen():
        for _ in range(TRIES):
            began_s = time.process_time()
            work()
            least_s = min(least_s, time.process_time() - began_s)
            if least_s < enough_s:
                break
    return least_s
