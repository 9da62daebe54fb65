"""The stop button of a command whose sessions are opened again when the bus is started anew."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from threading import Lock

from tailor.runtime.bus.session import Session
from tailor.schemas.messages import DriverState
from tailor.tools.operator.stop_button import StopButton


class CurrentButton:
    """Presses the button of the present session. Thread-safe."""

    def __init__(self) -> None:
        self._present: tuple[Session, StopButton] | None = None
        self._pressing = Lock()  # no session is closed under a press

    @property
    def connected(self) -> bool:
        """Whether an e-stop reaches the bus; if not, that no driver confirmed it means nothing."""
        present = self._present
        return present is not None and present[0].connected

    @contextmanager
    def of(self, session: Session) -> Iterator[None]:
        """Use a session, of a role that may publish the e-stop, for the duration of the context."""
        self._present = session, StopButton(session)
        try:
            yield
        finally:
            with self._pressing:
                self._present = None

    def press(self) -> Mapping[str, DriverState]:
        """Stop every driver, as `StopButton.press` does; nothing without a session."""
        with self._pressing:
            return {} if self._present is None else self._present[1].press()
