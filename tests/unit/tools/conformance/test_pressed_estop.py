"""An e-stop that people press while `check-driver` tries a driver is none that it resets."""

from argparse import Namespace

import pytest

from tailor.executive import domains
from tailor.runtime.bus.attachment import Origin
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import EStop
from tailor.tools.commands.drivers.check_driver import _check_free, _watched
from tailor.tools.conformance.bench import Bench
from tests.support.stand_ins.bad_drivers import SPEC, good

PERSON = "e" * 32
DOMAIN = domains.load("soccer")


class Person:
    """Publishes at a time: presses the e-stop, or holds a switch that is silent from then on, as after kill -9."""

    def __init__(self, link, at_s, stop):
        self.at_s, self.message, self.link, self.wait = at_s, EStop(stop), link, link.wait

    def __call__(self, seconds):
        if self.at_s is not None and self.link.now_s() >= self.at_s:
            self.at_s = None
            self.link.publish("estop", self.message, Origin(1, 1, PERSON))
        return self.wait(seconds)


def checked(link, *names):
    arguments = Namespace(robot="agilo", json=True, no_fit=True, top_speed=False)
    return _watched(Bench(link, DOMAIN, SPEC, fraction=0.2), arguments, list(names), "simulator")


@pytest.mark.promise("P38")
@pytest.mark.parametrize("stop", [True, False], ids=["an e-stop", "a switch"])
@pytest.mark.parametrize("after_s", [0.0, 0.7, 1.5, 2.2, 3.0])
@pytest.mark.parametrize("clause", ["stops_at_an_estop", "stops_when_a_held_switch_is_released", "stays_stopped"])
def test_it_ends_the_check_and_stays_latched(capsys, clause, after_s, stop):
    """The next clause reset it, and moved the robot again."""
    link = good()
    link.wait = Person(link, link.now_s() + after_s, stop)
    assert checked(link, clause, "keeps_an_estop_until_a_reset", "moves_as_commanded") is None
    assert "somebody pressed the e-stop, or let go of a dead man's switch: the check ends" in capsys.readouterr().err
    link.wait(1.0)
    assert link.node.driver.guard.mode == "estopped"
    assert link.node.driver.guard.output(link.now_ns()) == (0.0, 0.0)


def test_its_own_end_no_check_nor_does_a_switch_that_was_let_go_before():
    link = good()
    link.publish("estop", EStop(False), Origin(1, 1, PERSON))
    link.wait(1.0)
    assert link.node.driver.guard.mode == "estopped"
    assert checked(link).kept


def test_one_that_is_pressed_before_the_first_clause_is_refused_in_one_line():
    link = good()
    link.publish("estop", EStop(True), Origin(1, 1, PERSON))
    with pytest.raises(UsageError, match=r"^agilo: somebody pressed the e-stop, or let go of a dead man's switch$"):
        _check_free(Bench(link, DOMAIN, SPEC, fraction=0.2), "agilo", may_release=False)


@pytest.mark.promise("P38")
def test_one_that_a_reset_of_its_own_has_overtaken_is_latched_again():
    link = good()
    publish = link.publish

    def overtaken(topic, message, origin):
        if getattr(message, "reset", False):
            publish("estop", EStop(True), Origin(1, 1, PERSON))
            link.node.run_period()
            assert link.node.driver.guard.mode == "estopped"
        publish(topic, message, origin)

    link.publish = overtaken
    assert checked(link, "stops_at_an_estop", "moves_as_commanded") is None
    link.wait(1.0)
    assert link.node.driver.guard.mode == "estopped"
