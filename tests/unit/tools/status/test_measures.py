"""Measured rates, ages and tick times."""

import pytest

from tailor.tools.status.arrivals import MAX_SENDERS, Arrivals
from tailor.tools.status.picture import Spread, TickTimes
from tailor.tools.status.ticks import TickTimer, spread_ms
from tests.unit.tools.status.bus_feed import tick

S = 1_000_000_000


def test_the_rate_is_that_of_the_intervals_of_the_last_five_seconds():
    arrivals = Arrivals()
    for k in range(101):
        arrivals.add(k * S // 10, "a")
    assert arrivals.rate_hz(10 * S) == pytest.approx(10.0)
    assert arrivals.rate_hz(14 * S) == pytest.approx(10.0), "silence is an age, not a rate"
    assert arrivals.rate_hz(16 * S) == 0.0
    assert (arrivals.count, arrivals.age_s(16 * S)) == (101, 6.0)


def test_one_message_has_no_rate():
    arrivals = Arrivals()
    arrivals.add(0, "a")
    assert arrivals.rate_hz(S) is None
    arrivals.add(0, "a")
    assert arrivals.rate_hz(S) is None, "nor have two at the same instant"


def test_senders_count_for_a_second_and_stay_bounded():
    arrivals = Arrivals()
    for k in range(10 * MAX_SENDERS):
        arrivals.add(0, str(k))
    assert arrivals.senders(0) == MAX_SENDERS
    arrivals.add(S, "a")
    assert arrivals.senders(S) == MAX_SENDERS
    assert arrivals.senders(S + 1) == 1


def test_percentiles_are_values_that_occurred():
    assert spread_ms([k * 1_000_000 for k in range(1, 101)]) == Spread(50.0, 99.0, 100.0)
    assert spread_ms([2_000_000]) == Spread(2.0, 2.0, 2.0)
    assert spread_ms([3_000_000, 1_000_000]) == Spread(1.0, 3.0, 3.0)


def test_tick_times_cover_the_last_minute():
    timer = TickTimer()
    assert timer.times(0) is None
    timer.add(0, tick(work_ms=99.0, skipped=4))
    timer.add(30 * S, tick(work_ms=2.0, lateness_ms=0.5, skipped=1))
    timer.add(60 * S, tick(work_ms=4.0, lateness_ms=0.25))
    expected = TickTimes(2, 1, Spread(2.0, 4.0, 4.0), Spread(0.25, 0.5, 0.5))
    assert timer.times(60 * S) == expected
    assert timer.times(121 * S) is None
