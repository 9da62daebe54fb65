"""Session with the bus of a robot; what keeps one from opening is worded for that bus, not for Tailor's own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from tailor.runtime.bus.opening import open_client
from tailor.runtime.bus.rights.credentials import UnfitKeyError, identity_in
from tailor.runtime.bus.session import Session
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.simnodes.hardware.plain_settings import RobotBus

ABSENT = "the robot's router or bridge does not respond, expected it there (bus.connect)"
REFUSED = "opens no session of zenoh: another program listens there, or it wants a key (bus.key)"


@contextmanager
def robots_session(bus: RobotBus, endpoint: str) -> Iterator[Session]:
    """A session with the bus of a robot.

    Args:
      bus: Where it is.
      endpoint: That of `bus`, or of Tailor's bus for a robot without one of its own.

    Raises:
      ConnectionError: The robot's bus opens none.
      UsageError: Tailor's bus opens none.
    """
    identity = identity_in(bus.key) if bus.key else None
    with ExitStack() as stack:
        try:
            session = stack.enter_context(open_client(endpoint, role="driver", identity=identity))
        except UsageError as error:
            if not bus.connect:
                raise
            why = ABSENT if isinstance(error, UnreachableError) else REFUSED
            why = f"opens no session, since {error}" if isinstance(error, UnfitKeyError) else why
            raise ConnectionError(f"{bus.connect}: {why}") from error
        yield session
