"""Age of inputs, with exact limits: a stamp makes no data fresher, and what never came is stale."""

import pytest

from tailor.executive.core.sensing.freshness import newest_arrivals, stale_topics
from tests.support.toy_domain import odometry

MS = 1_000_000
KEY = "agilo/odom"


@pytest.mark.parametrize("stamp_ns", [0, 10**18])
def test_an_input_is_as_old_as_its_arrival_whatever_its_stamp(stamp_ns):
    sample = odometry(stamp_ns, 0.0, 1)
    arrived = {KEY: 100 * MS}
    assert newest_arrivals({}, (type(sample)(KEY, sample.message, 100 * MS, 1, "cd" * 16),)) == arrived
    assert stale_topics(("odom",), "agilo", arrived, 600 * MS) == ()
    assert stale_topics(("odom",), "agilo", arrived, 600 * MS + 1) == ("odom",)


def test_an_input_that_arrived_earlier_makes_the_newest_no_older():
    samples = tuple(odometry(at_ns, 0.0, 1) for at_ns in (100 * MS, 300 * MS, 200 * MS))
    assert newest_arrivals({KEY: 250 * MS, "agilo/driver": 5}, samples[:1]) == {KEY: 250 * MS, "agilo/driver": 5}
    assert newest_arrivals({}, samples) == {KEY: 300 * MS}


def test_what_never_came_is_stale_if_the_table_gives_it_a_limit():
    assert stale_topics(("odom", "ball"), "agilo", {}, 0) == ("odom",), "a ball need not be seen"
    assert stale_topics(("odom",), "agilo", {"nomad/odom": 0}, 0) == ("odom",)


def test_each_stale_input_is_named():
    arrivals = {KEY: 0, "agilo/pose": 0, "agilo/driver": 400 * MS}
    assert stale_topics(("odom", "pose", "driver"), "agilo", arrivals, 900 * MS) == ("odom",)
    assert stale_topics(("odom", "pose", "driver"), "agilo", arrivals, 1000 * MS + 1) == ("odom", "pose", "driver")
