"""Sessions are opened anew, or end, for the next run of a bus alone: closing one of a router that hangs takes 10 s."""

from __future__ import annotations

import argparse
import socket
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import pytest

from tailor.runtime.bus.rights.hosted_folder import hosted
from tailor.runtime.bus.rights.run_folder import SOCKET, RunFolder
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.tools.cli.systems import bus_renewal
from tailor.tools.cli.systems.bus_renewal import CHECK_NS, GONE_NS, BusRenewal, open_run, opened_anew

ENDPOINT = "tcp/127.0.0.1:7999"
GONE = GONE_NS + CHECK_NS


@pytest.fixture(autouse=True)
def base(tmp_path, monkeypatch):
    """Folder of all runs, as of a login session."""
    monkeypatch.delenv("TAILOR_RUN_DIR", raising=False)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))


@contextmanager
def bus(users=("people",)):
    """A run of a bus whose router accepts connections and does nothing else, as one that hangs does."""
    with hosted(ENDPOINT, users) as folder, socket.socket(socket.AF_UNIX) as router:
        router.bind(str(folder.path / SOCKET))
        router.listen()
        yield


@dataclass
class Cut:
    """A session that is connected until it is cut off."""

    connected: bool = True


def renewal(key=None):
    return BusRenewal(argparse.Namespace(connect=ENDPOINT, key=key, config=""))


def test_a_router_that_hangs_is_waited_for():
    with bus():
        watch, session = renewal(), Cut()
        assert not watch.due(session, 0)
        session.connected = False
        assert not any(watch.due(session, k * GONE) or watch.final(session, k * GONE + CHECK_NS) for k in range(1, 9))


@pytest.mark.parametrize("users", [("people",), ()], ids=["passwords", "open"])
def test_the_next_run_of_a_bus_needs_a_new_session(users):
    with bus(users):
        watch, session = renewal(), Cut()
        assert not watch.due(session, 0)
    session.connected = False
    assert not watch.due(session, GONE), "no router is there"
    with bus(users):
        assert watch.due(session, 2 * GONE)
        assert not watch.due(session, 2 * GONE + 1), "the folder is not read more often"
        session.connected = True
        assert not watch.due(session, 3 * GONE), "zenoh has reconnected by itself"
        session.connected = False
        assert not watch.due(session, 3 * GONE + CHECK_NS), "a moment ago it was"


def test_a_run_that_begins_while_a_session_is_opened_is_not_taken_for_its_own(monkeypatch):
    runs, session = ExitStack(), Cut()

    @contextmanager
    def open_slowly(arguments, role, sender):
        runs.close()
        runs.enter_context(bus())
        yield session

    monkeypatch.setattr(bus_renewal, "open_bus", open_slowly)
    with runs:
        runs.enter_context(bus())
        with open_run(argparse.Namespace(connect=ENDPOINT, key=None, config=""), "observer") as run:
            assert not run.due(0)
            session.connected = False
            assert run.due(GONE)


def test_a_key_outlives_the_bus():
    watch, session = renewal(key="tailor-keys/people"), Cut()
    assert not watch.due(session, 0)
    session.connected = False
    with bus():
        assert not watch.due(session, GONE)


@pytest.mark.parametrize(
    ("before", "after", "final"),
    [(("people",), ("people",), True), (("people",), (), True), ((), ("people",), True), ((), (), False)],
)
def test_a_session_ends_for_good_with_its_passwords_and_one_of_an_open_bus_does_not(before, after, final):
    with bus(before):
        watch, session = renewal(), Cut()
        assert not watch.final(session, 0)
    session.connected = False
    with bus(after):
        assert watch.final(session, GONE) == final


def test_a_loop_never_knocks_at_a_bus_that_hangs(monkeypatch):
    """Knocks that nobody answers fill a queue, and then the next one waits: for seconds, in the loop of a driver."""
    knocks = []
    monkeypatch.setattr(RunFolder, "running", knocks.append)
    with bus():
        watch, session = renewal(), Cut(connected=False)
        assert not any(watch.final(session, k * GONE) for k in range(3))
    assert knocks == []


@dataclass
class Wall:
    """A clock that sleeping moves on."""

    now_s: float = 0.0

    def monotonic(self):
        return self.now_s

    def sleep(self, seconds):
        self.now_s += seconds


@pytest.fixture
def wall(monkeypatch):
    """The clock of the module."""
    clock = Wall()
    monkeypatch.setattr(bus_renewal, "time", clock)
    return clock


def test_a_bus_that_refuses_for_long_ends_the_command_and_one_that_starts_does_not(wall):
    def opened(sessions):
        if wall.now_s > 1000:
            return "a session"
        refused = wall.now_s % 25 < 20  # not for REFUSED_S on end
        raise (UsageError("the bus belongs to another user") if refused else UnreachableError("no router responds"))

    assert opened_anew(ExitStack(), opened, lambda: False) == "a session"

    def refuses(sessions):
        raise UsageError("the bus belongs to another user")

    began_s = wall.now_s
    with pytest.raises(UsageError, match="another user"):
        opened_anew(ExitStack(), refuses, lambda: wall.now_s > began_s + 3600)
    assert wall.now_s - began_s == pytest.approx(bus_renewal.REFUSED_S, abs=1.0)


def test_a_command_that_is_to_end_waits_for_no_bus(wall):
    def unreachable(sessions):
        raise UnreachableError("no router responds")

    assert opened_anew(ExitStack(), unreachable, lambda: wall.now_s > 3600) is None
