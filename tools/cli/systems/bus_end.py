"""Ends a driver or an executive with the run of its bus, as systemd ends their services (`Requires=tailor-bus`).

On a bus that was started anew it would never be heard again. A robot has stopped by then, as its guard waits 0.3 s for
commands; people start the process again and arm the robot: a restart is never a resume.
"""

from __future__ import annotations

import argparse
import time

from tailor.runtime.bus.session import Session
from tailor.runtime.stopping import Stop
from tailor.schemas.errors import UnreachableError
from tailor.tools.cli.systems.bus_renewal import BusRenewal


class BusEnd:
    """When a loop is to end: on request, or when its session is cut off for good. To be made before the session."""

    def __init__(self, arguments: argparse.Namespace, stop: Stop) -> None:
        """`arguments`: parsed flags of `configure_bus`; `stop`: request to end."""
        self._renewal = BusRenewal(arguments)
        self._stop = stop
        self._cut_off = False

    def reached(self, session: Session) -> bool:
        """Whether the loop is to end; for every period, as it takes microseconds."""
        self._cut_off = self._cut_off or self._renewal.final(session, time.monotonic_ns())
        return self._stop.requested or self._cut_off

    def check(self) -> None:
        """Call it after the loop.

        Raises:
          UnreachableError: The bus was the reason; a supervisor may start the process again.
        """
        if self._cut_off:
            raise UnreachableError(
                f"bus endpoint {self._renewal.endpoint}: the bus was started anew, with other passwords; "
                "start this command again as well"
            )
