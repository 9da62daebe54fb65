"""Notices that the bus of this machine was started anew. Its passwords are new: zenoh cannot reconnect with the old."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import TypeVar

from tailor.runtime.bus.rights.run_folder import run_folder
from tailor.runtime.bus.session import Session
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.schemas.services import Role
from tailor.tools.cli.systems.endpoint import bus_settings, open_bus

GONE_NS = 1_000_000_000  # without a router; zenoh reconnects to an open bus by itself before
CHECK_NS = 200_000_000
RETRY_S = 0.2  # while the bus is starting
REFUSED_S = 30.0  # a bus that starts or ends refuses for seconds; one of another user, or a wrong flag, for ever

Opened = TypeVar("Opened")


class BusRenewal:
    """Watches the session of a command that outlives the bus. To be made before the session is opened."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        """`arguments`: parsed flags of `configure_bus`."""
        settings = bus_settings(arguments)
        self.endpoint = settings.endpoint
        self._folder = None if settings.key else run_folder(settings.endpoint)  # a key outlives the bus
        self._run = None if self._folder is None else self._folder.run
        self._secured = self._folder is not None and self._folder.secured
        self._connected_ns: int | None = None
        self._checked_ns: int | None = None

    def due(self, session: Session, now_ns: int) -> bool:
        """Whether the session is cut off and another run of the bus is there: new sessions have to be opened.

        To a router that stood still zenoh reconnects by itself, and to close a session of one takes ten seconds.

        Args:
          session: Opened after this object was made.
          now_ns: Monotonic time.
        """
        if self._checked_ns is not None and now_ns - self._checked_ns < CHECK_NS:
            return False
        self._checked_ns = now_ns
        if self._connected_ns is None or session.connected:
            self._connected_ns = now_ns
        if self._folder is None or now_ns - self._connected_ns <= GONE_NS:
            return False
        return self._folder.run != self._run and self._folder.running()

    def final(self, session: Session, now_ns: int) -> bool:
        """As `due`, and there are other passwords: this session never connects again, as that of an open bus does."""
        if not self.due(session, now_ns) or self._folder is None:
            return False
        return self._secured or self._folder.secured  # each run makes new passwords


@dataclass(frozen=True, slots=True)
class BusRun:
    """One run of the bus, as a command that outlives it sees it."""

    session: Session
    _renewal: BusRenewal

    def due(self, now_ns: int) -> bool:
        """Whether sessions with the next run have to be opened; see `BusRenewal.due`."""
        return self._renewal.due(self.session, now_ns)


@contextmanager
def open_run(arguments: argparse.Namespace, role: Role, sender: str = "") -> Iterator[BusRun]:
    """Session with the present run of the bus.

    Args:
      arguments: Parsed flags of `configure_bus`.
      role: See `open_bus`.
      sender: See `open_bus`.

    Raises:
      UsageError: Wrong flags, no router, or no access.
    """
    renewal = BusRenewal(arguments)  # first: it would take a run that begins in between for that of the session
    with open_bus(arguments, role, sender=sender) as session:
        yield BusRun(session, renewal)


def opened_anew(sessions: ExitStack, opened: Callable[[ExitStack], Opened], ended: Callable[[], bool]) -> Opened | None:
    """Close the sessions of a run of the bus and open those of the next.

    Args:
      sessions: What `opened` entered.
      opened: Opens all sessions of the command; tried until it succeeds, each time up to three seconds.
      ended: Whether the command is to end instead.

    Returns:
      What `opened` returns; None if the command is to end.

    Raises:
      UsageError: A router has refused for REFUSED_S; for one that does not respond yet it waits without a limit.
    """
    refused_s: float | None = None  # since when
    while not ended():
        sessions.close()
        try:
            return opened(sessions)
        except UnreachableError:  # the router is not ready yet, or has ended again
            refused_s = None
        except UsageError:
            now_s = time.monotonic()
            refused_s = now_s if refused_s is None else refused_s
            if now_s - refused_s >= REFUSED_S:
                raise
        time.sleep(RETRY_S)
    return None
