"""The emergency-stop key of a live view: each press stops every driver, beside the view's own work."""

from __future__ import annotations

from threading import Thread
from typing import Protocol

from rich.text import Text

from tailor.tools.cli.plain_text import plain
from tailor.tools.status.picture import Picture

KEYS = frozenset(b"s \x13")  # Ctrl-S, too: whoever presses it means s
MAX_WAITING = 4  # presses that wait for an earlier one to be confirmed


class Button(Protocol):
    """Stops every driver; `tailor.tools.operator.stop_button.StopButton` does."""

    @property
    def connected(self) -> bool:
        """Whether a press reaches the bus."""
        ...

    def press(self) -> object:
        """Return when every driver has confirmed, or after a time limit."""
        ...


class StopKey:
    """Presses the button in threads of its own, so that neither drawing nor a flood delays an e-stop.

    A press while the bus is lost is repeated once it is back.
    """

    def __init__(self, button: Button) -> None:
        self._button = button
        self._pressed = self._unheard = False
        self._presses: list[Thread] = []

    def poll(self, keys: bytes) -> None:
        """Take the keys since the last call, any of which may be the stop key."""
        pressed = bool(KEYS.intersection(keys))
        if not pressed and not (self._unheard and self._button.connected):
            return
        self._pressed, self._unheard = True, not self._button.connected
        self._presses = [press for press in self._presses if press.is_alive()]
        if len(self._presses) < MAX_WAITING:
            self._presses.append(Thread(target=self._button.press, daemon=True))
            self._presses[-1].start()

    def finish(self) -> None:
        """Wait until all presses are confirmed, or have reached their time limit."""
        for press in self._presses:
            press.join()

    def line(self, picture: Picture, keyboard: bool) -> Text:
        """The line that names the key, if there is a keyboard, and after a press the mode of every driver."""
        if not keyboard:
            return Text("no keyboard: no emergency stop from here", "yellow")
        text = Text(" s or space: EMERGENCY STOP ", "bold white on red").append("  q: quit  ", "default on default")
        if self._pressed:
            text.append(plain(f"pressed: {self._outcome(picture)}"), "bold red on default")
        return text

    def _outcome(self, picture: Picture) -> str:
        if not self._button.connected:
            return "NOT CONFIRMED: the bus is lost; use tailor estop"
        modes = [f"{driver.robot} is {'silent' if driver.silent else driver.mode}" for driver in picture.drivers]
        return ", ".join(modes) or "NOT CONFIRMED: no driver is heard on the bus"
