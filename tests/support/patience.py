"""Waits for conditions instead of times, always bounded."""

import select
import signal
import time
from contextlib import contextmanager

PATIENCE_S = 90.0  # a process starts in 2 s, and a busy machine runs ten others; only failures wait


def wait_until(condition, what="condition", timeout_s=PATIENCE_S):
    """Value of the condition as soon as it is true; fails the test after `timeout_s`."""
    ends = time.monotonic() + timeout_s
    while time.monotonic() < ends:
        if value := condition():
            return value
        time.sleep(0.005)
    raise AssertionError(f"{what}: not within {timeout_s} s")


@contextmanager
def interrupted_after(seconds, what="block"):
    """Fails the test if the block, of the main thread, takes longer: also one that waits in a call of the system."""

    def fail(*_):
        raise AssertionError(f"{what}: not within {seconds} s")

    before = signal.signal(signal.SIGALRM, fail)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def first_line(stream):
    """First line that a process writes to its pipe."""
    assert select.select([stream], [], [], PATIENCE_S)[0], f"no line within {PATIENCE_S} s"
    return stream.readline()


def is_alive(pid):
    """Whether a process runs; a zombie that nobody has waited for yet is dead enough."""
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def gone(pid):
    """Whether a process ends soon."""
    ends = time.monotonic() + PATIENCE_S / 3
    while is_alive(pid) and time.monotonic() < ends:
        time.sleep(0.005)
    return not is_alive(pid)
