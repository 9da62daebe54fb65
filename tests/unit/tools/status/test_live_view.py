"""The live view across runs of the bus: keys that are pressed between two sessions, and its last state."""

from __future__ import annotations

import argparse
import time
from contextlib import contextmanager, nullcontext
from types import SimpleNamespace

import pytest

from tailor.runtime.stopping import Stop
from tailor.schemas.errors import UsageError
from tailor.tools.cli.systems import bus_renewal
from tailor.tools.cli.systems.bus_renewal import BusRun
from tailor.tools.status import live_view
from tailor.tools.status.live_view import LiveView
from tailor.tools.status.stop_key import StopKey
from tests.support.stand_ins.silent_session import SilentSession

BUS = argparse.Namespace(connect="tcp/127.0.0.1:7999", key=None, config="")


class Keys:
    """A keyboard: what is pressed by each look at it."""

    there = True

    def __init__(self, *pressed):
        self.waiting = list(pressed)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def read(self):
        return self.waiting.pop(0) if self.waiting else b"q"


class Button:
    """Counts its presses; without a session none counts."""

    def __init__(self):
        self.connected, self.stops = False, 0

    @contextmanager
    def of(self, session):
        self.connected = True
        yield
        self.connected = False

    def press(self):
        heard = self.connected
        time.sleep(0.05)  # until the drivers confirm
        self.stops += heard


@pytest.fixture
def viewed(monkeypatch):
    """viewed(keys, opening, due): the button and the last state of a view whose sessions open or not, and are due."""

    def view(keys, opening=(True,), due=()):
        openings, dues, button = iter(opening), iter(due), Button()

        class Renewal:
            def due(self, session, now_ns):
                return next(dues, False)

        @contextmanager
        def open_run(arguments, role):
            if not next(openings):
                raise UsageError("no router responds")
            yield BusRun(SilentSession(), Renewal())

        for name, stand_in in (
            ("open_run", open_run),
            ("open_bus", lambda arguments, role: nullcontext(SilentSession())),
            ("CurrentButton", lambda: button),
            ("Keyboard", lambda: Keys(*keys)),
        ):
            monkeypatch.setattr(live_view, name, stand_in)
        monkeypatch.setattr(bus_renewal, "RETRY_S", 0.0)
        return button, LiveView(BUS, Stop()).run()

    return view


@pytest.mark.parametrize("between", [[b"s", b"", b""], [b"", b" ", b""], [b"", b"", b"s"]])
def test_a_stop_key_that_is_pressed_while_the_bus_is_opened_again_stops_its_next_run(viewed, between):
    button, _ = viewed([b"", *between, b""], opening=(True, False, False, True), due=(True,))
    assert button.stops == 1


def test_a_view_without_a_press_stops_nothing_after_the_bus_was_opened_again(viewed):
    button, _ = viewed([b"", b"", b"x", b""], opening=(True, False, True), due=(True,))
    assert button.stops == 0


def test_the_last_state_is_read_after_a_last_press_was_confirmed(viewed, monkeypatch):
    confirmed, button = [], {}
    monkeypatch.setattr(live_view, "StopKey", lambda given: button.setdefault("key", StopKey(given)))
    monkeypatch.setattr(live_view.Watcher, "poll", lambda *_: confirmed.append(button["key"]._button.stops))
    viewed([b"", b"s"])
    assert (confirmed[0], confirmed[-1]) == (0, 1)


def test_the_last_state_is_that_of_the_moment_up_to_which_the_bus_was_read(viewed, monkeypatch):
    clock = iter(range(10**9, 10**12, 10**9))  # a second passes between any two looks at the clock
    read = []
    monkeypatch.setattr(live_view, "time", SimpleNamespace(monotonic_ns=lambda: next(clock), sleep=time.sleep))
    monkeypatch.setattr(live_view.Watcher, "poll", lambda self, now_ns: read.append(now_ns))
    monkeypatch.setattr(live_view.SystemModel, "__init__", lambda self, now_ns: None)
    monkeypatch.setattr(live_view.SystemModel, "picture", lambda self, now_ns: now_ns)
    monkeypatch.setattr(LiveView, "_draw", lambda *_: None)
    _, last = viewed([b"", b""])
    assert last == read[-1]
