"""Calls beside a loop: it waits for none of them, and learns of those that failed."""

import errno
import os
import threading
import time

import pytest

from tailor.runtime import aside as module
from tailor.runtime.aside import aside
from tests.support.patience import wait_until


def test_calls_are_made_in_order_and_all_at_the_end():
    made = []
    with aside() as calls:
        for number in range(100):
            calls.call(lambda number=number: made.append(number))
    assert made == list(range(100))


def test_nobody_waits_for_a_call_that_stalls_and_the_newest_is_made_after_it(monkeypatch):
    monkeypatch.setattr(module, "FINISH_S", 0.05)
    stalls, goes_on, made = threading.Event(), threading.Event(), []
    with aside(most=1) as calls:
        calls.call(lambda: stalls.set() or goes_on.wait())
        stalls.wait()
        began_s = time.monotonic()
        for number in range(1000):
            calls.call(lambda number=number: made.append(number))
        assert time.monotonic() - began_s < 1.0
    assert made == []
    goes_on.set()
    assert wait_until(lambda: made)[-1] == 999


def test_what_a_call_raises_is_raised_to_the_next_caller():
    def closed():
        raise BrokenPipeError

    def fails():
        with pytest.raises(BrokenPipeError):
            calls.call(print)
        return True

    with aside() as calls:
        calls.call(closed)
        wait_until(lambda: calls._error)
        assert fails()


def test_output_that_cannot_be_made_is_lost_and_the_next_one_is_made():
    made = []

    def full():
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with aside() as calls:
        for function in (full, lambda: made.append(1), full, lambda: made.append(2)):
            calls.output(function)
            wait_until(lambda: not calls._waiting)
    assert made == [1, 2]
    assert calls._error is None
