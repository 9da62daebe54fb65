"""The guard that repeats an attempt: only a measured stall of the machine permits it."""

import os
import threading
import time
from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from tests.support.stalls import MAX_STALL_S, PERIOD_S, StallMeter, repeat_on_stall

QUIET_S, STALLED_S = MAX_STALL_S, MAX_STALL_S * 1.01


def failing(times):
    """An attempt that fails so often, and the list of its calls."""
    calls = []

    def attempt():
        calls.append(len(calls))
        assert len(calls) > times, "promise broken"
        return "kept"

    return attempt, calls


def meters(*worst_s):
    """A meter that measures these stalls, one an attempt."""
    stalls = iter(worst_s)
    return lambda: nullcontext(SimpleNamespace(worst_s=next(stalls)))


def test_a_failure_without_a_stall_counts_at_once():
    attempt, calls = failing(1)
    with pytest.raises(AssertionError, match="promise broken"):
        repeat_on_stall(3, attempt, meters(QUIET_S, QUIET_S))
    assert len(calls) == 1


def test_a_failure_during_a_stall_is_repeated():
    attempt, calls = failing(1)
    assert repeat_on_stall(3, attempt, meters(STALLED_S, QUIET_S)) == "kept"
    assert len(calls) == 2


def test_a_failure_after_a_stalled_one_counts_if_the_machine_did_not_stall_again():
    attempt, calls = failing(2)
    with pytest.raises(AssertionError, match="promise broken"):
        repeat_on_stall(3, attempt, meters(STALLED_S, QUIET_S))
    assert len(calls) == 2


def test_a_program_that_always_fails_fails_however_often_the_machine_stalls():
    attempt, calls = failing(9)
    with pytest.raises(AssertionError, match="promise broken"):
        repeat_on_stall(3, attempt, meters(STALLED_S, STALLED_S))
    assert len(calls) == 3


def test_only_broken_promises_are_repeated():
    def broken():
        raise ValueError("a bug of the test")

    with pytest.raises(ValueError, match="a bug"):
        repeat_on_stall(3, broken, meters(STALLED_S))


def fake_meter(sleeps_s, uses_cpu_s=0.0):
    """A meter with a clock of its own, in which each sleep takes so long and the process works so much meanwhile."""
    now = SimpleNamespace(s=100.0, cpu_s=5.0)

    def sleep(_):
        now.s += sleeps_s
        now.cpu_s += uses_cpu_s

    return StallMeter(clock=lambda: now.s, sleep=sleep, cpu_clock=lambda: now.cpu_s)


def test_lateness_is_measured_against_the_deadline():
    meter = fake_meter(PERIOD_S + 0.07)
    meter.measure_once()
    assert meter.worst_s == pytest.approx(0.07)


def test_work_of_the_test_process_itself_is_not_a_stall():
    meter = fake_meter(PERIOD_S + 0.07, uses_cpu_s=0.07)
    meter.measure_once()
    assert meter.worst_s == pytest.approx(0.0)


def test_a_meter_measures_on_each_cpu_while_it_is_open():
    allowed = os.sched_getaffinity(0)
    measured: set[frozenset[int]] = set()
    every = threading.Event()

    def sleep(period_s):
        measured.add(frozenset(os.sched_getaffinity(0)))
        if len(measured) == len(allowed):
            every.set()
        time.sleep(period_s)

    with StallMeter(sleep=sleep):
        assert every.wait(timeout=30.0)
    assert measured == {frozenset({cpu}) for cpu in allowed}
    assert os.sched_getaffinity(0) == allowed
