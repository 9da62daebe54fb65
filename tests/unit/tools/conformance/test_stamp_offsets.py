"""Stamps far from their arrival are a remark: the driver's clock may be another one, or its measurements are late."""

from dataclasses import replace

import pytest

from tailor.executive import domains
from tailor.tools.conformance.bench import Bench
from tailor.tools.conformance.report import Report, line, markdown, values
from tailor.tools.conformance.stamp_offsets import stamp_offsets
from tailor.tools.conformance.suite import verdicts
from tests.support.stand_ins.bad_drivers import SPEC, good

DOMAIN = domains.load("soccer")
UNIX_S = 1.7e9  # more than MAX_OFFSET_S from the clock of a link that counts from 1 s


def remarks(behind_s, unstamped=False):
    """Of a driver whose odometry has such stamps, and takes 0.02 to 0.06 s over the bus."""
    link = good()
    wait, shift_s = link.wait, iter([0.06, 0.02] * 10_000)

    def shifted(each):
        if each.topic != "odom":
            return each
        message = replace(each.message, stamp_ns=0 if unstamped else max(1, each.message.stamp_ns))
        return replace(each, message=message, stamp_s=each.stamp_s - behind_s - next(shift_s))

    link.wait = lambda seconds: [shifted(each) for each in wait(seconds)]
    bench = Bench(link, DOMAIN, SPEC, fraction=0.2)
    bench.wait(1.0)
    return list(stamp_offsets(bench))


@pytest.mark.parametrize(
    ("behind_s", "found"),
    [
        (5.0, ["odom: stamps are 5.02 s behind their arrival: the driver's clock is, or its measurements are so late"]),
        (-3600.0, ["odom: stamps are 3599.98 s ahead of their arrival: the driver's clock is"]),
        (UNIX_S, ["odom: stamps are no wall time"]),
        (0.0, []),
    ],
)
def test_stamps_that_are_far_from_their_arrival_are_stated(behind_s, found):
    """check-driver passed them without a word, and nothing compensates for a measurement that is late."""
    lines = remarks(behind_s)
    assert len(lines) == len(found), lines
    assert all(each.startswith(start) for each, start in zip(lines, found, strict=True)), lines


def test_a_sensor_without_stamps_has_no_offset():
    assert remarks(5.0, unstamped=True) == []


def test_a_remark_breaks_no_clause_and_stands_in_every_report():
    report = Report("agilo", "hardware", [], remarks=["odom: stamps are no wall time"])
    assert report.kept
    assert "## Remarks\n\n- odom: stamps are no wall time" in markdown(report)
    assert values(report)["remarks"] == ["odom: stamps are no wall time"]


def test_a_good_driver_gets_no_remark():
    bench = Bench(good(), DOMAIN, SPEC, fraction=0.2)
    assert [line(each) for each in verdicts(bench, ["keeps_its_rates"])] == ["kept       keeps its rates"]
    assert list(stamp_offsets(bench)) == []
