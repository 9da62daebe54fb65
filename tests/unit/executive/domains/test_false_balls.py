"""Which percepts of a ball are doubted: those that begin another track, of a ball that has been seen."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive import domains
from tailor.schemas.messages import Odometry, PoseEstimate, Sample
from tailor.schemas.messages.soccer import BallPercept
from tailor.schemas.topics import key_of

SOCCER, DOUBTS = domains.load("soccer"), domains.doubts("soccer")
TICK = 100_000_000
STILL = (0.0, 0.0)


def seen(belief, n, x, y=0.0, topic="ball", variance=1e-3):
    sample = Sample(key_of(topic, "agilo"), BallPercept(n * TICK, x, y, variance, variance, 0.0), n * TICK, n)
    return SOCCER.update(belief, n * TICK, (sample,), STILL)


def doubted(before, n, x, topic="ball", by="ball"):
    """Whether a percept of tick n contradicts the belief, which is predicted to its arrival as the core does."""
    before = SOCCER.update(before, n * TICK, (), STILL)
    return DOUBTS[by](before, seen(before, n, x, topic=topic))


def located():
    samples = (
        Sample("agilo/odom", Odometry(0, 0.0, 0.0, 0.0, 0.0, 0.0), TICK, 1),
        Sample("agilo/pose", PoseEstimate(0, 0.0, 0.0, 0.0, 1e-3, 1e-3, 1e-3), TICK, 1),
    )
    return SOCCER.update(SOCCER.initial_belief(), TICK, samples, STILL)


def test_the_first_sight_of_a_ball_is_believed():
    assert not doubted(located(), 2, 1.0)


@pytest.mark.parametrize(("x", "found"), [(1.0, False), (1.1, False), (0.9, False), (1.6, True), (0.3, True)])
def test_a_ball_that_would_be_elsewhere_at_once_is_doubted(x, found):
    assert doubted(seen(seen(located(), 2, 1.0), 3, 1.0), 4, x) is found


def test_each_ball_is_doubted_by_its_own_topic():
    before = seen(seen(seen(located(), 2, 1.0), 2, 2.0, topic="ball2"), 3, 2.0, topic="ball2")
    assert doubted(before, 4, 3.0, topic="ball2", by="ball2")
    assert not doubted(before, 4, 3.0, topic="ball2", by="ball")


def test_of_two_percepts_that_differ_none_is_better():
    assert not doubted(seen(located(), 2, 1.0), 3, 2.0)


def test_a_ball_that_was_out_of_sight_for_long_is_believed_where_it_is_seen():
    before = seen(located(), 2, 1.0)
    before = replace(before, ball=replace(before.ball, variance=0.04))
    assert not doubted(before, 3, 2.2)
