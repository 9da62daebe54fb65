"""Whoever starts a second driver of a robot is told so: each writes to the same base, and nobody can arm either."""

import threading
from argparse import Namespace
from contextlib import contextmanager, nullcontext
from types import SimpleNamespace

import pytest

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.inbox import Raw
from tailor.tools.commands.drivers import driver
from tailor.tools.commands.run import sim
from tailor.tools.launch import other_drivers

OWN, OTHER = "a" * 32, "b" * 32


class Session:
    """A session that has heard states of these drivers."""

    sender = OWN

    def __init__(self, *senders: str, key: str = "agilo/driver") -> None:
        self.judged = threading.Event()
        self._heard = [Raw(key, b"", pack(Origin(n, 0, each)), "", True, None) for n, each in enumerate(senders)]
        self._heard.append(Raw(key, b"", b"damaged", "", True, None))

    def subscribe_all(self, pattern: str):
        assert pattern == "agilo/driver"
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
    monkeypatch.setattr(other_drivers, "LISTEN_S", 0.0)
    reported: list[str] = []
    with other_drivers.other_drivers_noted(session, "agilo", reported.append):
        assert session.judged.wait(5.0)
    assert [line.partition("`")[0] for line in reported] == lines


def test_a_driver_that_ends_at_once_does_not_wait_for_others() -> None:
    session, reported = Session(OTHER), []
    with other_drivers.other_drivers_noted(session, "agilo", reported.append):
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
