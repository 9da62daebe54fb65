"""The recorder's session: all that is published goes into one queue, across restarts of the bus."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.service import ServiceServer
from tailor.schemas.errors import UsageError
from tailor.tools.cli.systems.bus_renewal import BusRun, open_run
from tailor.tools.cli.systems.endpoint import sender_of


class RecorderBus:
    """Session of a recorder; when the bus was started anew, another one with the passwords of that run.

    Attributes:
      queue: What was received.
      requests: Requests of the service; None without one, or while there is no session.
    """

    def __init__(self, arguments: argparse.Namespace, service: str) -> None:
        """`arguments`: parsed flags of `configure_bus` and `configure_sender`; `service`: its key, empty for none."""
        self.queue = IngestQueue()
        self.requests: ServiceServer | None = None
        self._arguments, self._service = arguments, service
        self._sessions = ExitStack()
        self._run: BusRun | None = None

    @property
    def connected(self) -> bool:
        """Whether messages can arrive."""
        return self._run is not None and self._run.session.connected

    @contextmanager
    def opened(self) -> Iterator[None]:
        """Receive for the duration of the context.

        Raises:
          UsageError: No router responds, or it refuses this user.
        """
        with self._sessions:
            self._open()
            yield

    def renew(self, now_ns: int) -> None:
        """Open another session if one is due; takes up to three seconds while the bus is starting."""
        if self._run is not None and not self._run.due(now_ns):
            return
        self._run, self.requests = None, None
        self._sessions.close()
        try:
            self._open()
        except UsageError:  # the router is not ready yet, or has ended again
            return

    def _open(self) -> None:
        run = self._sessions.enter_context(open_run(self._arguments, "recorder", sender_of(self._arguments)))
        _, subscription = run.session.subscribe_all("**", self.queue)
        self._sessions.callback(subscription.undeclare)
        self.requests = run.session.service_server(self._service) if self._service else None
        self._run = run
