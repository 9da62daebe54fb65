"""Patience with a busy machine: waits for conditions instead of times, always bounded, and more than one try."""

import select
import time
from contextlib import suppress

PATIENCE_S = 90.0  # a process needs two seconds to start, and a machine may be busy with ten others; only failures wait


def wait_until(condition, what="condition", timeout_s=PATIENCE_S):
    """What the condition gives as soon as it is true; fails the test after `timeout_s`."""
    ends = time.monotonic() + timeout_s
    while time.monotonic() < ends:
        if found := condition():
            return found
        time.sleep(0.005)
    raise AssertionError(f"{what}: not within {timeout_s} s")


def in_one_try_of(tries, attempt):
    """What the first attempt gives that holds. A stalled machine spoils one of them; a broken program spoils all."""
    for _ in range(tries - 1):
        with suppress(AssertionError):
            return attempt()
    return attempt()


def first_line(stream):
    """The first line that a process writes to its pipe."""
    assert select.select([stream], [], [], PATIENCE_S)[0], f"nothing said within {PATIENCE_S} s"
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
