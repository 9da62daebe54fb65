"""Measures how much CPU time a piece of work needs, however busy the machine is and however fast."""

import gc
import time
from collections.abc import Callable

from tailor.runtime.gc_freeze import gc_frozen

REPETITIONS = 3  # other processes evict caches, which only adds CPU time: as in timeit, the minimum is the measurement
REFERENCE_S = 0.025  # what `reference` takes on the machine that limits in seconds are meant for, by definition


def reference() -> object:
    """A fixed piece of work of the project's kind: tuples that are made, looked up, entered and sorted."""
    numbers: dict[tuple[str, int, int], int] = {}
    for fact in ((f"o{n % 97}", n % 61, n % 53) for n in range(10_000)):
        if fact not in numbers:
            numbers[fact] = len(numbers)
    return sorted(numbers, key=lambda fact: (fact[1], fact[0]))


def standard_cpu_s(work: Callable[[], object]) -> float:
    """CPU time of `work` in seconds of the standard machine: one on which `reference` takes REFERENCE_S.

    Work and reference are measured side by side, each at its fastest of three repetitions, all of which are always
    made. So a limit holds alike on machines that are twice as fast or as slow. The test runner's own objects are kept
    out of the garbage collections that are measured with the work.
    """
    gc.collect()
    measured_s: dict[Callable[[], object], list[float]] = {work: [], reference: []}
    with gc_frozen():
        for _ in range(REPETITIONS):
            for piece, durations_s in measured_s.items():
                began_s = time.process_time()
                piece()
                durations_s.append(time.process_time() - began_s)
    return min(measured_s[work]) / min(measured_s[reference]) * REFERENCE_S
