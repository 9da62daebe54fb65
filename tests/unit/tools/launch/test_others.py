"""Whoever starts a second driver of a robot, or a second executive, is told so: nobody can arm either by its name."""

import threading
from argparse import Namespace
from contextlib import contextmanager, nullcontext
from types import SimpleNamespace

import pytest

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.inbox import Raw
from tailor.tools.commands.drivers import driver
from tailor.tools.commands.run import executive, sim
from tailor.tools.launch import others

OWN, OTHER = "a" * 32, "b" * 32


class Session:
    """A session that has heard states of these drivers."""

    sender = OWN

    def __init__(self, *senders: str, key: str = "agilo/driver", subscribed: str = "agilo/driver") -> None:
        self.judged, self._subscribed = threading.Event(), subscribed
        self._heard = [Raw(key, b"", pack(Origin(n, 0, each)), "", True, None) for n, each in enumerate(senders)]
        self._heard.append(Raw(key, b"", b"damaged", "", True, None))

    def subscribe_all(self, pattern: str):
        assert pattern == self._subscribed
        drained = iter([self._heard])
        return SimpleNamespace(drain=lambda: next(drained)), SimpleNamespace(undeclare=self.judged.set)


@pytest.mark.parametrize(
    ("session", "lines"),
    [
        (Session(), []),
        (Session(OWN, OWN), []),
        (Session(OTHER, key="agilo/other"), []),
        (Session(OWN, OTHER, OTHER), ["another driver of agilo is on the bus: bbbbbbbb; expected one: "]),
    ],
)
def test_another_driver_is_reported_once(monkeypatch, session, lines) -> None:
    monkeypatch.setattr(others, "LISTEN_S", 0.0)
    reported: list[str] = []
    with others.other_drivers_noted(session, "agilo", reported.append):
        assert session.judged.wait(5.0)
    assert [line.partition("`")[0] for line in reported] == lines


@pytest.mark.parametrize(
    ("senders", "lines"),
    [((), []), ((OWN,), []), ((OWN, OTHER), ["another executive is on the bus: bbbbbbbb; expected one: each takes "])],
)
def test_another_executive_is_reported_once(monkeypatch, senders, lines) -> None:
    monkeypatch.setattr(others, "LISTEN_S", 0.0)
    session, reported = Session(*senders, key="exec/status", subscribed="exec/status"), list[str]()
    with others.other_executives_noted(session, reported.append):
        assert session.judged.wait(5.0)
    assert [line.partition("every goal")[0] for line in reported] == lines


def test_an_executive_listens_while_it_ticks(monkeypatch) -> None:
    """A second one said nothing: each of them took the goals that people sent to the one that they knew."""
    events: list[str] = []

    @contextmanager
    def noted(session, report):
        events.append("listens")
        yield
        events.append("over")

    class Shell:
        def __init__(self, *_) -> None:
            self.state = None

        def run(self, goal, until):
            events.append(f"pursues {goal}")

    context = SimpleNamespace(domain=SimpleNamespace(name="soccer", robot="agilo"))
    put = {
        "other_executives_noted": noted,
        "open_bus": lambda *_, **__: nullcontext(SimpleNamespace(sender=OWN)),
        "build_context": lambda *_, **__: context,
        "replace": lambda same, **_: same,
        "provenance": lambda *_: {},
        "_goal": lambda *_: "(b)",
        "beginning": lambda *_: "",
        "driver_of": lambda *_: None,
        "Shell": Shell,
        "BusEnd": lambda *_: SimpleNamespace(check=lambda: None),
        "stop_on_signals": lambda: SimpleNamespace(requested=False),
        "codec": SimpleNamespace(prime=lambda: None),
        "numpy_blocks": SimpleNamespace(fill=lambda: None),
        "realtime": SimpleNamespace(prepare=dict),
        "state_lines": lambda *_: nullcontext(),
    }
    nothing = "set_for_loop", "deployment_from", "check_package", "executive_config", "check_models", "check_driver"
    for name in (*nothing, "sensor_rates_hz", "core_source", "source_entry", "platform_fingerprint"):
        monkeypatch.setattr(executive, name, lambda *_: None)
    for name, value in put.items():
        monkeypatch.setattr(executive, name, value)
    words = {"domain": "soccer", "driver": None, "driver_sender": "", "sender": "", "once": False}
    assert executive.run(Namespace(**words)) == 0
    assert events == ["listens", "pursues (b)", "over"]


def test_a_driver_that_ends_at_once_does_not_wait_for_others() -> None:
    session, reported = Session(OTHER), []
    with others.other_drivers_noted(session, "agilo", reported.append):
        pass
    assert session.judged.is_set()
    assert reported == []


@pytest.mark.parametrize("command", [driver, sim])
def test_both_sorts_of_drivers_listen_while_they_run(monkeypatch, command) -> None:
    """A second `tailor driver` printed nothing, and wrote zeros beside the commands of the first."""
    events: list[str] = []

    @contextmanager
    def noted(session, robot, report):
        events.append(robot)
        yield
        events.append("over")

    class Node:
        def __init__(self, *_, **__) -> None:
            self.world = None

        def run(self, *_) -> bool:
            events.append("runs")
            return True

    robot = SimpleNamespace(robot="agilo", body=SimpleNamespace(robot="agilo"))
    put = {
        "other_drivers_noted": noted,
        "open_bus": lambda *_, **__: nullcontext(SimpleNamespace()),
        "driver_spec_to_run": lambda _: None,
        "hardware_of": lambda *_: robot,
        "_world": lambda *_: robot,
        "deployment_from": lambda _: SimpleNamespace(scenario="", executive=SimpleNamespace(seed=0)),
        "bus_settings": lambda _: SimpleNamespace(endpoint=""),
        "BusEnd": lambda *_: SimpleNamespace(check=lambda: None, reached=lambda _: True),
        "HardwareNode": Node,
        "Node": Node,
        "codec": SimpleNamespace(prime=lambda: None),
        "realtime": SimpleNamespace(take_fifo=lambda _: 0, elevate_bus_threads=lambda: 0, DRIVER_PRIORITY=0),
        "stop_on_signals": lambda: None,
        "_run": lambda node, *_: node.run(),
    }
    for name, value in put.items():
        monkeypatch.setattr(command, name, value, raising=False)
    words = {"robot": "agilo", "hardware": "", "leave": "", "sender": "", "attempts": 0, "speed": 1.0}
    assert command.run(Namespace(**words)) == 0
    assert events == ["agilo", "runs", "over"]
