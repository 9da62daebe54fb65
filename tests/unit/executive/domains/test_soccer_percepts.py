"""What a camera cannot have seen is not believed: a robot would leave the field for it."""

import pytest

from tailor.executive import domains
from tailor.executive.interfaces.domain_results import measurement_fault
from tailor.schemas.messages import Odometry
from tailor.schemas.messages.soccer import BallPercept, OpponentPercept, OpponentPercepts

SOCCER = domains.load("soccer")


def ball(x, y):
    return BallPercept(0, x, y, 0.01, 0.01, 0.0)


def opponents(*places):
    return OpponentPercepts(0, tuple(OpponentPercept(x, y, 0.2, 0.01, 0.01, 0.0) for x, y in places))


@pytest.mark.parametrize(
    ("message", "fault"),
    [
        (ball(0.0, 31.0), "has a ball 31 m away"),
        (ball(-3e5, 4e5), "has a ball 500000 m away"),
        (opponents((2.0, 1.0), (0.0, -40.0)), "has an opponent 40 m away"),
    ],
)
def test_a_percept_beyond_every_field_is_no_measurement(message, fault):
    assert measurement_fault(SOCCER, SOCCER.initial_belief(), message) == fault


@pytest.mark.parametrize(
    "message", [ball(20.0, 20.0), opponents(), opponents((29.0, 0.0)), Odometry(0, 1e5, 0.0, 0.0, 0.0, 0.0)]
)
def test_other_messages_are_believed(message):
    assert measurement_fault(SOCCER, SOCCER.initial_belief(), message) == ""
