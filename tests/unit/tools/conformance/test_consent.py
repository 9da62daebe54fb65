"""`tailor check-driver` moves hardware with a person's consent alone, and only if no other driver obeys it as well."""

import builtins
import dataclasses
import sys
from types import SimpleNamespace

import pytest

from tailor.runtime.bus.service import no_service
from tailor.schemas.errors import UsageError
from tailor.schemas.messages import DriverState
from tailor.schemas.own import example
from tailor.tools.commands.drivers import check_driver
from tailor.tools.conformance.bench import Bench
from tailor.tools.conformance.link import Heard

STEP = "agilo/sim/step"


class Link:
    """Drivers that publish their states, by epoch and mode."""

    def __init__(self, *drivers):
        self.drivers, self.at_s = drivers, 0.0

    def now_s(self):
        return self.at_s

    def wait(self, seconds):
        self.at_s += seconds
        states = [dataclasses.replace(example(DriverState), epoch=epoch, mode=mode) for epoch, mode in self.drivers]
        return [Heard(self.at_s, self.at_s, "driver", state, "", "d" * 32, 1) for state in states]


def free(*drivers, may_release=False):
    check_driver._check_free(Bench(Link(*drivers), None, None, 0.1), "agilo", may_release)


def test_one_driver_that_nobody_uses_is_tried():
    free((7, "disarmed"))
    with pytest.raises(UsageError, match="agilo: it publishes no state"):
        free()
    with pytest.raises(UsageError, match="agilo is armed for "):
        free((7, "armed"))


@pytest.mark.promise("P38")
def test_one_that_somebody_has_stopped_is_tried_once_people_release_it():
    """Whoever stopped it may stand before it: `--yes` of a script released the e-stop, and the robot moved."""
    with pytest.raises(UsageError, match=r"agilo is e-stopped \(.*\), expected --reset to release that"):
        free((7, "estopped"))
    free((7, "estopped"), may_release=True)


def test_none_of_several_drivers_is_tried():
    """A forgotten simulator beside hardware: the two passed for a simulator, and the hardware moved unasked."""
    with pytest.raises(UsageError, match="several drivers of agilo are on the bus"):
        free((7, "disarmed"), (8, "disarmed"))


@pytest.mark.parametrize(
    ("answer", "simulator"),
    [
        ((False, "step: pause first"), True),
        ((False, "step: expected a number of periods, 1 to 6000"), True),
        ((False, no_service(STEP)), False),
        ((False, "no response within 1 s"), False),
        ((True, "stored"), False),
    ],
)
def test_only_a_simulator_that_answers_is_none_that_needs_consent(answer, simulator):
    people = SimpleNamespace(call=lambda key, text, timeout_s: answer)
    assert check_driver._is_simulator(people, "agilo") == simulator


def terminal(monkeypatch, typed):
    def ask(question):
        if typed is None:
            raise EOFError
        return typed

    monkeypatch.setattr(sys, "stdin", SimpleNamespace(isatty=lambda: True))
    monkeypatch.setattr(builtins, "input", ask)


@pytest.mark.parametrize("typed", [None, "", "yes"])
def test_whoever_does_not_type_the_robots_name_moves_nothing(monkeypatch, typed):
    """None: Ctrl-D."""
    terminal(monkeypatch, typed)
    with pytest.raises(UsageError, match="not confirmed, so nothing was moved"):
        check_driver._confirm("agilo", agreed=False)


def test_whoever_types_it_consents(monkeypatch):
    terminal(monkeypatch, " agilo ")
    check_driver._confirm("agilo", agreed=False)


def test_nobody_consents_where_standard_input_is_closed(monkeypatch):
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(UsageError, match="expected --yes or a terminal to confirm"):
        check_driver._confirm("agilo", agreed=False)
    check_driver._confirm("agilo", agreed=True)
