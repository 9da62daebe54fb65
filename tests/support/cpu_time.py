"""Measures how much CPU time a piece of work needs, however busy the machine is and however fast."""

import gc
import signal
import statistics
import time
from collections.abc import Callable

from tailor.runtime.gc_freeze import gc_disabled, gc_frozen

REPETITIONS = 2  # other processes evict caches, which only adds CPU time: as in timeit, the minimum is the measurement
REFERENCE_S = 0.020  # of `reference` on the machine that limits are meant for, by definition (seen: 0.014 to 0.028)
OWN_S = 0.03  # of work between two references: a machine's speed may change within a tenth of a second


def reference() -> object:
    """A fixed piece of work of the project's kind: tuples that are made, looked up, entered and sorted."""
    numbers: dict[tuple[str, int, int], int] = {}
    for fact in ((f"o{n % 97}", n % 61, n % 53) for n in range(10_000)):
        if fact not in numbers:
            numbers[fact] = len(numbers)
    return sorted(numbers, key=lambda fact: (fact[1], fact[0]))


def standard_cpu_s(work: Callable[[], object]) -> float:
    """CPU time of `work` in seconds of the standard machine: one on which `reference` takes REFERENCE_S.

    So a limit holds alike on machines that are twice as fast or as slow, and while their speed changes: references
    interrupt the work. The test runner's own objects are kept out of the garbage collections that are measured with
    the work. Only the main thread of a process can measure.
    """
    gc.collect()
    with gc_frozen():
        return min(_references_long(work) for _ in range(REPETITIONS)) * REFERENCE_S


def _references_long(work: Callable[[], object]) -> float:
    """How many times as long as the references before and during it the work takes."""
    with gc_disabled():
        references_s = [_cpu_s(reference)]

    def interrupt(*_: object) -> None:
        with gc_disabled():  # or collections of the work's objects would be those of the reference
            references_s.append(_cpu_s(reference))
        signal.setitimer(signal.ITIMER_PROF, OWN_S)

    before = signal.signal(signal.SIGPROF, interrupt)
    signal.setitimer(signal.ITIMER_PROF, OWN_S)
    try:
        whole_s = _cpu_s(work)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
    return (whole_s - sum(references_s[1:])) / statistics.mean(references_s)


def _cpu_s(work: Callable[[], object]) -> float:
    began_s = time.process_time()
    work()
    return time.process_time() - began_s
