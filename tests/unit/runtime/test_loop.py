"""Arithmetic of the loop, with a simulated clock."""

import pytest

from tailor.runtime.budget import ClockBudget
from tailor.runtime.loop import Loop, Period

MS = 1_000_000


class SteppedClock:
    def __init__(self, now_ns=0, oversleep_ns=0):
        self.now, self.oversleep = now_ns, oversleep_ns

    def now_ns(self):
        return self.now

    def sleep_until(self, deadline_ns):
        self.now = max(self.now, deadline_ns + self.oversleep)


def test_periods_start_at_absolute_deadlines_however_long_the_work_takes():
    clock = SteppedClock(7 * MS)
    loop = Loop(100 * MS, clock)
    assert loop.wait_for_next_period() == Period(7 * MS, 7 * MS, 0)
    for k, work in enumerate([0, 30, 99, 60], start=1):
        clock.now += work * MS
        assert loop.wait_for_next_period() == Period((7 + 100 * k) * MS, (7 + 100 * k) * MS, 0)


def test_oversleeping_is_lateness_and_does_not_accumulate():
    clock = SteppedClock(0, oversleep_ns=3 * MS)
    loop = Loop(100 * MS, clock)
    loop.wait_for_next_period()
    turns = [loop.wait_for_next_period() for _ in range(5)]
    assert [t.lateness_ns for t in turns] == [3 * MS] * 5
    assert turns[-1].deadline_ns == 500 * MS


@pytest.mark.promise("P26")
def test_an_overrun_skips_whole_periods_and_keeps_the_phase():
    clock = SteppedClock()
    loop = Loop(100 * MS, clock)
    loop.wait_for_next_period()
    clock.now = 250 * MS
    assert loop.wait_for_next_period() == Period(200 * MS, 250 * MS, 1)
    assert loop.wait_for_next_period() == Period(300 * MS, 300 * MS, 0)
    clock.now = 1000 * MS
    assert loop.wait_for_next_period() == Period(1000 * MS, 1000 * MS, 6)


def test_a_tick_that_just_fills_its_period_skips_nothing():
    clock = SteppedClock()
    loop = Loop(100 * MS, clock)
    loop.wait_for_next_period()
    clock.now = 199 * MS
    assert loop.wait_for_next_period() == Period(100 * MS, 199 * MS, 0)


@pytest.mark.promise("P22")
def test_a_clock_that_goes_back_does_not_break_the_loop():
    clock = SteppedClock(1000 * MS)
    loop = Loop(100 * MS, clock)
    loop.wait_for_next_period()
    clock.now = 500 * MS
    assert loop.wait_for_next_period() == Period(1100 * MS, 1100 * MS, 0)


def test_a_period_must_be_positive():
    with pytest.raises(ValueError, match="period_ns"):
        Loop(0, SteppedClock())


def test_a_clock_budget_counts_what_it_grants_and_stays_spent():
    times = iter([0, 10, 20, 30, 5])
    budget = ClockBudget(25, lambda: next(times))
    assert [budget.spent() for _ in range(5)] == [False, False, False, True, True]
    assert budget.granted == 3
