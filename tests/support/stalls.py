"""Measures stalls of the machine during a test, so that only a measured stall repeats an attempt."""

import os
import threading
import time

PERIOD_S = 0.01  # ten samples in the shortest period that the tests promise anything about, a tick of 0.1 s
MAX_STALL_S = 0.025  # half of the tightest limit in these tests, 50 ms for one poll; a quiet machine stays below 10 ms


class StallMeter:
    """Lateness of threads that wake on absolute deadlines, one thread pinned to each CPU; a context manager.

    CPU time that the test process itself used is subtracted: its own work is not a stall of the machine.
    """

    def __init__(self, period_s=PERIOD_S, clock=time.monotonic, sleep=time.sleep, cpu_clock=time.process_time):
        self.worst_s = 0.0
        self._period_s, self._clock, self._sleep, self._cpu_clock = period_s, clock, sleep, cpu_clock
        self._ended = threading.Event()
        self._threads = [threading.Thread(target=self._watch, args=(cpu,)) for cpu in os.sched_getaffinity(0)]

    def __enter__(self):
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, *error):
        self._ended.set()
        for thread in self._threads:
            thread.join()  # a thread that is late now is counted as well

    def _watch(self, cpu):
        os.sched_setaffinity(0, {cpu})  # of this thread alone
        while not self._ended.is_set():
            self.measure_once()

    def measure_once(self):
        """Sleep for one period and take its lateness into account."""
        deadline_s, used_s = self._clock() + self._period_s, self._cpu_clock()
        self._sleep(self._period_s)
        late_s = self._clock() - deadline_s - (self._cpu_clock() - used_s)
        self.worst_s = max(self.worst_s, late_s)


def repeat_on_stall(attempts, attempt, meter=StallMeter):
    """Result of `attempt`, which may fail and be repeated only while the machine stalls.

    Without a measured stall the first outcome counts, whatever it is. An attempt that fails while the machine stalled
    for more than `MAX_STALL_S` proves nothing: its outcome is discarded and the attempt repeated, at most `attempts`
    times in all. The last outcome counts in any case. An attempt that succeeds in spite of a stall kept its promise.
    """
    for _ in range(attempts - 1):
        with meter() as measured:
            try:
                return attempt()
            except AssertionError as error:
                failure = error
        if measured.worst_s <= MAX_STALL_S:
            raise failure
        print(f"repeated: the machine stalled for {measured.worst_s * 1e3:.0f} ms ({failure})")
    return attempt()
