"""Stamps of a clock beyond ROS's 31 bits of seconds: a message can be sent, whatever the time of day."""

import struct
from dataclasses import replace

import pytest

from tailor.schemas.codec import decode, encode
from tailor.schemas.messages import DriverState, LogLine, VelocityCommand
from tailor.schemas.own import example
from tailor.schemas.ros_time import MAX_STAMP_NS, wrapped_ns

YEAR_2040_NS = 2_208_988_800 * 10**9


@pytest.mark.parametrize(
    ("stamp_ns", "wrapped"),
    [
        (0, 0),
        (MAX_STAMP_NS, MAX_STAMP_NS),
        (MAX_STAMP_NS + 1, 0),
        (YEAR_2040_NS + 7, YEAR_2040_NS + 7 - 2**31 * 10**9),
        (2 * MAX_STAMP_NS + 1, MAX_STAMP_NS),
    ],
)
def test_stamps_begin_again_after_the_last_second_that_ros_can_hold(stamp_ns, wrapped):
    assert wrapped_ns(stamp_ns) == wrapped
    assert decode(VelocityCommand, encode(VelocityCommand(stamp_ns, 0.3, 0.1))) == VelocityCommand(wrapped, 0.3, 0.1)


@pytest.mark.parametrize("stamp_ns", [2 * MAX_STAMP_NS + 2, 2**62])
def test_a_stamp_that_no_clock_of_the_bus_shows_is_a_mistake(stamp_ns):
    with pytest.raises(struct.error):
        encode(VelocityCommand(stamp_ns, 0.3, 0.1))


@pytest.mark.promise("P22")
@pytest.mark.parametrize("kind", [DriverState, VelocityCommand, LogLine])
def test_a_message_of_the_year_2040_can_be_sent(kind):
    message = replace(example(kind), stamp_ns=YEAR_2040_NS)
    assert decode(kind, encode(message)).stamp_ns == wrapped_ns(YEAR_2040_NS)
