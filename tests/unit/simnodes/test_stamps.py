"""Stamps of commands, with exact values; test_guard.py has those of delayed commands."""

from tailor.simnodes.reasons import CommandRefusal
from tailor.simnodes.stamps import SETTLED, Stamps

MS = 1_000_000
HOUR_NS = 3_600_000 * MS
CLOCK = 10**18  # the sender's, at our time 0


def settled(count=SETTLED, delay_ns=20 * MS):
    """Stamps of so many commands at 10 Hz, and the time of the next one."""
    stamps = Stamps()
    for k in range(count):
        stamps.accept(k * 100 * MS + delay_ns, CLOCK + k * 100 * MS)
    return stamps, count * 100 * MS


def test_a_command_100_ms_faster_than_the_fastest_is_accepted_and_a_faster_one_is_not():
    stamps, now_ns = settled()
    assert stamps.refusal(now_ns, CLOCK + now_ns + 80 * MS) is None
    assert stamps.refusal(now_ns, CLOCK + now_ns + 80 * MS + 1) is CommandRefusal.FROM_THE_FUTURE


def test_the_first_ten_commands_may_be_slower_than_those_that_follow():
    stamps, now_ns = settled(SETTLED - 1, delay_ns=250 * MS)
    assert stamps.refusal(now_ns, CLOCK + now_ns) is None
    stamps.accept(now_ns, CLOCK + now_ns)
    assert stamps.refusal(now_ns, CLOCK + now_ns + 101 * MS) is CommandRefusal.FROM_THE_FUTURE


def test_an_accepted_faster_command_is_the_measure_of_all_later_ones():
    stamps, now_ns = settled()
    stamps.accept(now_ns, CLOCK + now_ns)
    assert stamps.refusal(now_ns, CLOCK + now_ns - 300 * MS) is None
    assert stamps.refusal(now_ns, CLOCK + now_ns - 300 * MS - 1) is CommandRefusal.LATE


def test_clocks_may_drift_apart_by_100_ppm_for_hours():
    for ppm in (100, -100):
        stamps = Stamps()
        for now_ns in range(0, 5 * HOUR_NS, 60_000 * MS):
            stamp_ns = CLOCK + now_ns - now_ns * ppm // 1_000_000
            assert stamps.refusal(now_ns, stamp_ns) is None
            stamps.accept(now_ns, stamp_ns)


def test_a_delay_that_grows_faster_than_clocks_drift_is_refused_in_the_end():
    stamps = Stamps()
    for now_ns in range(0, HOUR_NS, 1000 * MS):
        stamp_ns = CLOCK + now_ns - now_ns // 1000
        if stamps.refusal(now_ns, stamp_ns) is not None:
            break
        stamps.accept(now_ns, stamp_ns)
    assert now_ns == 334_000 * MS, "0.3 s later than the drift explains"


def test_a_sender_whose_clock_is_hours_behind_is_judged_alike():
    stamps = Stamps()
    for now_ns in range(10 * HOUR_NS, 10 * HOUR_NS + SETTLED * 100 * MS, 100 * MS):
        assert stamps.refusal(now_ns, now_ns - 9 * HOUR_NS) is None
        stamps.accept(now_ns, now_ns - 9 * HOUR_NS)
    assert stamps.refusal(now_ns, now_ns - 9 * HOUR_NS - 300 * MS) is None
    assert stamps.refusal(now_ns, now_ns - 9 * HOUR_NS - 301 * MS) is CommandRefusal.LATE


def test_a_command_without_a_stamp_is_neither_judged_nor_a_measure():
    stamps, now_ns = settled()
    assert stamps.refusal(now_ns, 0) is None
    stamps.accept(now_ns, 0)
    assert stamps.refusal(now_ns, CLOCK + now_ns - 320 * MS) is None
    assert stamps.refusal(now_ns, CLOCK + now_ns - 321 * MS) is CommandRefusal.LATE
