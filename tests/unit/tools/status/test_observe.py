"""`tailor status` that prints once judges the moment up to which it has read the bus."""

from __future__ import annotations

import time
from contextlib import nullcontext
from itertools import count
from types import SimpleNamespace

import pytest

from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.stopping import Stop
from tailor.tools.commands.look import status
from tailor.tools.main import main


class Observed:
    """A watcher and a model that remember the moments that they are given."""

    def __init__(self) -> None:
        self.polled_ns = 0

    def poll(self, now_ns: int) -> None:
        self.polled_ns = now_ns

    def incomplete(self, now_ns: int) -> bool:
        return False

    def picture(self, now_ns: int) -> int:
        return now_ns


def test_an_observer_that_stands_still_after_its_last_look_finds_nobody_silent(monkeypatch) -> None:
    observed, stalls_ns = Observed(), count(0, 10**9)  # a second passes between any two looks at the clock
    monkeypatch.setattr(time, "monotonic_ns", stalls_ns.__next__)
    assert status._observe(observed, observed, 0.2, Stop()) == observed.polled_ns > 0


@pytest.mark.parametrize("connected", [True, False])
def test_a_bus_that_is_lost_meanwhile_is_no_bus_without_a_robot(monkeypatch, capsys, connected) -> None:
    """Behind a router that hung, nobody was heard: `no driver`, `no executive`."""
    ended = SimpleNamespace(undeclare=lambda: None)
    session = SimpleNamespace(subscribe_all=lambda pattern: (IngestQueue(), ended), connected=connected)
    monkeypatch.setattr(status, "open_bus", lambda arguments, role: nullcontext(session))
    monkeypatch.setattr(status.os, "nice", lambda niceness: 0)
    assert main(["status", "--seconds", "0.2"]) == (1 if connected else 2)
    output, errors = capsys.readouterr()
    assert ("no driver" in output, "was lost while it was observed" in errors) == (connected, not connected)
