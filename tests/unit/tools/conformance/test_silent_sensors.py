"""A driver whose sensors are silent, seldom or without stamps."""

from dataclasses import replace

import pytest

from tailor.executive import domains
from tailor.schemas.messages import EStop
from tailor.simnodes.guard import Mode
from tailor.simnodes.world import World
from tailor.tools.conformance.bench import Bench
from tailor.tools.conformance.publishing_clauses import publishes_no_stale_data
from tailor.tools.conformance.simulated_link import SimulatedLink
from tailor.tools.conformance.suite import verdicts
from tests.support.stand_ins.bad_drivers import SPEC, good
from tests.support.stand_ins.body import FakeBody

DOMAIN = domains.load("soccer")


class Untrue(FakeBody):
    """As hardware, it publishes no ground truth."""

    def advance(self, duration_ns):
        return [reading for reading in super().advance(duration_ns) if self.publishes(reading)]

    def publishes(self, reading):
        return reading.topic != "truth"


class RollsOnInSilence(Untrue):
    """Has brakes and odometry while it is armed only."""

    guard = None

    def command(self, values):
        if any(values) or self.is_armed:
            super().command(values)

    def publishes(self, reading):
        silent = reading.topic == "odom" and (self.v or self.omega) and not self.is_armed
        return super().publishes(reading) and not silent

    @property
    def is_armed(self):
        return self.guard is not None and self.guard.mode is Mode.ARMED


class Seldom(Untrue):
    """Its odometry comes twice a second."""

    def publishes(self, reading):
        return super().publishes(reading) and (reading.topic != "odom" or reading.time_ns % 500_000_000 == 0)


def judged(body, *clauses):
    link = SimulatedLink(World(body, {}, 0), SPEC)
    body.guard = link.node.driver.guard
    return list(verdicts(Bench(link, DOMAIN, SPEC, fraction=0.2), clauses))


@pytest.mark.parametrize("clause", ["stops_without_commands", "stops_at_an_estop"])
def test_a_robot_that_rolls_on_in_silence_does_not_count_as_stopped(clause):
    body = RollsOnInSilence()
    (verdict,) = judged(body, clause)
    assert body.v > 0.1
    assert (verdict.faults, verdict.skipped) == ((), "no sensor shows the speed of v, omega any more")


def test_a_robot_that_shows_its_motion_seldom_moves_as_commanded_and_stops():
    found = judged(Seldom(), "moves_as_commanded", "stays_stopped", "stops_at_an_estop")
    assert [(each.faults, each.skipped) for each in found] == [((), "")] * 3


def test_messages_without_a_stamp_are_not_old_ones():
    """Each was said to be: the stamp that a package's own message leaves out counted as 0."""
    link = good()
    wait = link.wait
    link.wait = lambda seconds: [replace(each, message=bare(each)) for each in wait(seconds)]
    assert list(publishes_no_stale_data(Bench(link, DOMAIN, SPEC, fraction=0.2))) == []


def bare(heard):
    return EStop(stop=False) if heard.topic == "odom" else heard.message
