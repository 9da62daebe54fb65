"""What `tailor arm` and `tailor goal` print when the one whom they mean is not heard."""

import json
from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from tailor.runtime.bus.inbox import Raw
from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.service import no_service
from tailor.schemas.codec import encode
from tailor.schemas.messages import DriverState
from tailor.simnodes.reasons import ArmRefusal
from tailor.tools.commands.run import arm, goal
from tailor.tools.main import main
from tailor.tools.operator import arming_exchange
from tests.support.bus_system import bus_system


@pytest.fixture(scope="module")
def endpoint():
    with bus_system() as (_, endpoint, _):
        yield endpoint


def test_a_goal_that_nobody_hears_says_what_may_be_wrong(endpoint, capsys):
    assert main(["goal", "--json", "--connect", endpoint]) == 2
    assert json.loads(capsys.readouterr().out) == {
        "accepted": False,
        "answer": "no service at exec/goal: no executive is running, or it stands still; `tailor status` tells",
    }


def test_a_goal_of_a_key_that_nobody_hears_names_the_role_that_it_needs(capsys, monkeypatch):
    """A bus tells no other role that it may not ask, and the executive that runs is not found."""
    session = SimpleNamespace(call_all=lambda key, text: [(False, no_service(key))], connected=True)
    monkeypatch.setattr(goal, "open_bus", lambda arguments, role: nullcontext(session))
    assert main(["goal", "--key", "viewer"]) == 2
    assert "viewer: a key sends goals only if its role is people (tailor keys list)\n" in capsys.readouterr().err


def test_a_goal_whose_bus_is_lost_says_that_it_may_count(capsys, monkeypatch):
    session = SimpleNamespace(call_all=lambda key, text: [(False, no_service(key))], connected=False)
    monkeypatch.setattr(goal, "open_bus", lambda arguments, role: nullcontext(session))
    assert main(["goal"]) == 2
    assert capsys.readouterr().err == (
        "the bus was lost before an answer came: the request may count or not; `tailor status` shows the goal\n"
    )


def test_arming_without_an_executive_says_what_may_be_wrong(endpoint, capsys, monkeypatch):
    monkeypatch.setattr(arm, "WAIT_S", 0.2)
    assert main(["arm", "agilo", "--connect", endpoint]) == 1
    assert capsys.readouterr().out == (
        "no executive is heard: none is running, or it stands still; expected one, or --sender\n"
    )


class HeardDrivers:
    """A session on whose bus the drivers of some robots are heard."""

    def __init__(self, *robots):
        self.robots = robots

    def subscribe_all(self, pattern):
        queue, state = IngestQueue(), encode(DriverState(0, "disarmed", "just started", "", 1, "", 0))
        for robot in self.robots:
            queue.put(Raw(f"{robot}/driver", state, None, "", True, None))
        return queue, SimpleNamespace(undeclare=lambda: None)


@pytest.mark.parametrize(
    ("robots", "text"),
    [(("b21", "agilo"), "; drivers are heard of: agilo, b21"), ((), "; drivers are heard of: none")],
)
def test_a_robot_without_a_driver_is_answered_with_those_that_are_heard(robots, text):
    assert arm._others(HeardDrivers(*robots)) == text


@pytest.mark.parametrize(
    ("refusal", "advice"),
    [
        (ArmRefusal.ESTOP_LATCHED, " (`tailor arm agilo --reset` arms it)"),
        (ArmRefusal.OTHER_SENDER_ARMED, " (`tailor arm agilo --off` disarms it)"),
        (ArmRefusal.NOT_READY, ""),
    ],
)
def test_a_refusal_names_the_command_that_removes_its_cause(endpoint, capsys, monkeypatch, refusal, advice):
    before = DriverState(0, "disarmed", "just started", "", 1, "", 0)
    exchange = SimpleNamespace(state=before, reported=before, refusal=refusal.value)
    monkeypatch.setattr(arm, "_exchange", lambda *_: (arming_exchange.Outcome.REFUSED, exchange))
    assert main(["arm", "agilo", "--sender", "a" * 32, "--connect", endpoint]) == 1
    assert capsys.readouterr().out == f"refused: {refusal}; agilo is disarmed: just started{advice}\n"


def test_arming_a_misspelt_robot_ends_with_them(endpoint, capsys, monkeypatch):
    monkeypatch.setattr(arming_exchange, "WAIT_S", 0.2)
    monkeypatch.setattr(arm, "_others", lambda session: "; drivers are heard of: agilo")
    assert main(["arm", "agil", "--sender", "a" * 32, "--connect", endpoint]) == 1
    assert capsys.readouterr().out == "not sent; the driver of agil does not respond; drivers are heard of: agilo\n"
