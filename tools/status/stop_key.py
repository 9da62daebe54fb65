"""The emergency-stop key of a live view: from the first press on, the e-stop is published repeatedly."""

from __future__ import annotations

from rich.text import Text

from tailor.runtime.bus.publisher import Publisher
from tailor.schemas.messages import EStop
from tailor.tools.cli.plain_text import plain
from tailor.tools.status.picture import Picture

KEYS = frozenset(b"s ")
REPEAT_NS = 50_000_000  # a publication may be lost
LASTING_NS = 3_000_000_000  # after the last press; a person may arm again after that


class StopKey:
    """Publishes the e-stop for a while after each press."""

    def __init__(self, publisher: Publisher) -> None:
        """`publisher`: of the topic `estop`."""
        self._publisher = publisher
        self._pressed_ns: int | None = None
        self._published_ns = 0

    def poll(self, keys: bytes, now_ns: int) -> None:
        """Take the keys since the last call, any of which may be the stop key; publish when due."""
        if KEYS.intersection(keys):
            self._pressed_ns, self._published_ns = now_ns, now_ns - REPEAT_NS
        lasting = self._pressed_ns is not None and now_ns - self._pressed_ns <= LASTING_NS
        if lasting and now_ns - self._published_ns >= REPEAT_NS:
            self._published_ns = now_ns
            self._publisher.publish(EStop(True))

    def line(self, picture: Picture, keyboard: bool) -> Text:
        """The line that names the key, if there is a keyboard, and after a press the mode of every driver."""
        if not keyboard:
            return Text("no keyboard: no emergency stop from here", "yellow")
        text = Text(" s or space: EMERGENCY STOP ", "bold white on red").append("  q: quit  ", "default on default")
        if self._pressed_ns is not None:
            modes = [f"{driver.robot} is {driver.mode}" for driver in picture.drivers]
            text.append(plain("pressed: " + (", ".join(modes) or "no driver is on the bus")), "bold red on default")
        return text
