"""Services of the simulator without a bus."""

import json

import pytest

from tailor.simnodes.services import Services
from tailor.simnodes.world import World
from tests.support.stand_ins.body import FakeBody


class Request:
    def __init__(self, text):
        self.text, self.reply = text, None

    def accept(self, text):
        self.reply = (True, text)

    def refuse(self, reason):
        self.reply = (False, reason)


class Server:
    def __init__(self, *requests):
        self.waiting = list(requests)

    def poll(self):
        return self.waiting.pop(0) if self.waiting else None


def call(name, text, paused=False):
    resets = []
    request = Request(text)
    services = Services(World(FakeBody(), {"x": 2.0}, 3), {name: Server(request)}, on_reset=lambda: resets.append(1))
    services.paused = paused
    services.answer()
    return services, request.reply, resets


def test_services_execute_legal_requests():
    services, reply, resets = call("reset", json.dumps({"seed": 9, "start": {"x": 5}}))
    assert (reply, resets, services._world.body.state["x"]) == ((True, "reset"), [1], 5.0)
    assert call("reset", "")[1] == (True, "reset")
    events = [{"at_s": 0.0, "ball_x": 7}]
    services, reply, _ = call("reset", json.dumps({"start": {"x": 5}, "events": events}))
    services._world.begin()
    services._world.advance(10_000_000)
    assert (reply, services._world.body.state["ball_x"]) == ((True, "reset"), 7.0)
    services, reply, _ = call("place", '{"ball_x": 4}')
    assert (reply, services._world.body.state["ball_x"]) == ((True, "placed"), 4.0)
    assert call("pause", "true")[0].paused
    services, reply, _ = call("step", "25", paused=True)
    assert (reply, services.steps_due) == ((True, "25 periods"), 25)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("reset", "[]"),
        ("reset", '{"sed": 1}'),
        ("reset", '{"seed": -1}'),
        ("reset", '{"seed": true}'),
        ("reset", '{"start": {"x": NaN}}'),
        ("reset", '{"events": []}'),
        ("reset", '{"start": {"x": 1}, "events": [3]}'),
        ("reset", '{"start": {"x": 1}, "events": {}}'),
        ("reset", '{"start": {"x": 1}, "events": [{"ball_x": 1}]}'),
        ("reset", '{"start": {"x": 1}, "events": [{"at_s": -1, "ball_x": 1}]}'),
        ("reset", '{"start": {"x": 1}, "events": [{"at_s": 1, "ball_z": 1}]}'),
        ("reset", json.dumps({"start": {"x": 1}, "events": [{"at_s": 1}] * 101})),
        ("place", "3"),
        ("place", '{"x": "1"}'),
        ("place", '{"x": Infinity}'),
        ("pause", "1"),
        ("step", "0"),
        ("step", "1000000"),
        ("step", "1.5"),
        ("step", "not json"),
        ("place", "[" * 100_000),
    ],
)
def test_services_refuse_senseless_requests(name, text):
    services, reply, resets = call(name, text, paused=True)
    assert reply[0] is False
    assert (resets, services.steps_due) == ([], 0)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("place", '{"x": 7}'),
        ("reset", '{"start": {"x": 7}}'),
        ("reset", '{"start": {}, "events": [{"at_s": 1, "x": 7}]}'),
    ],
)
def test_services_refuse_what_the_body_cannot_take(name, text, monkeypatch):
    refuse = lambda self, values: "x is 7, expected less" if values.get("x") == 7 else ""  # noqa: E731
    monkeypatch.setattr(FakeBody, "refusal", refuse, raising=False)
    services, reply, resets = call(name, text)
    assert (reply, resets) == ((False, f"{name}: x is 7, expected less"), [])
    assert services._world.body.state["x"] == 2.0
    assert call("place", '{"x": 3}')[1] == (True, "placed")


def test_stepping_needs_a_pause():
    assert call("step", "1")[1] == (False, "step: pause first")


def test_no_more_steps_are_due_than_one_request_may_name():
    step = Request("4000"), Request("4000")
    services = Services(World(FakeBody(), {"x": 2.0}, 3), {"step": Server(*step)}, on_reset=lambda: None)
    services.paused = True
    services.answer()
    services.answer()
    refusal = "step: 4000 periods are still due, expected at most 6000 with the new ones"
    assert [each.reply for each in step] == [(True, "4000 periods"), (False, refusal)]
    assert services.steps_due == 4000


@pytest.mark.parametrize(("name", "text"), [("pause", "false"), ("pause", "true"), ("reset", "")])
def test_steps_that_are_still_due_end_with_their_pause_and_their_world(name, text):
    servers = {"step": Server(Request("4000")), name: Server(Request("null"), Request(text))}
    services = Services(World(FakeBody(), {"x": 2.0}, 3), servers, on_reset=lambda: None)
    services.paused = True
    services.answer()
    assert services.take_steps(50) == 50
    services.answer()
    assert services.steps_due == 0
