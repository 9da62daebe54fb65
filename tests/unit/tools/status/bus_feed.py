"""A model fed with messages as they come over the bus, at times that the test chooses."""

from __future__ import annotations

from tailor.runtime.bus.attachment import Origin, pack
from tailor.runtime.bus.encoding import encoding_of
from tailor.runtime.bus.inbox import Raw
from tailor.schemas import messages as m
from tailor.schemas.codec import encode
from tailor.schemas.topics import TOPICS, key_of
from tailor.tools.status.picture import Picture
from tailor.tools.status.system_model import SystemModel

EXECUTIVE, DRIVER, OTHER = "ab" * 16, "cd" * 16, "ef" * 16


def raw_of(key: str, message: m.Message, sender: str = DRIVER, sequence: int = 1) -> Raw:
    encoding = encoding_of(type(message))
    return Raw(key, encode(message), pack(Origin(sequence, 0, sender)), encoding, True, None)


def driver(mode: str = "armed", reason: str = "", armed_sender: str = EXECUTIVE, epoch: int = 7) -> m.DriverState:
    return m.DriverState(0, mode, reason, "", epoch, armed_sender, 5, ("other sender",), (2,))


def status(mode: str = "EXECUTING", reason: str = "", detail: str = "") -> m.ExecStatus:
    return m.ExecStatus(0, 1, mode, reason, "approach", "(atball pos3)", "", "goToPose", 0, 1.0, 5.0, detail=detail)


def tick(work_ms: float = 1.0, lateness_ms: float = 0.1, skipped: int = 0) -> m.TickReport:
    return m.TickReport(0, 1, 0, round(lateness_ms * 1e6), 0, round(work_ms * 1e6), skipped, 0, "", False)


class Feed:
    """A model and its time, in seconds since the start."""

    def __init__(self) -> None:
        self.model = SystemModel(0)
        self.now_s = 0.0
        self._sequence = 0

    def put(self, topic: str, message: m.Message, sender: str = DRIVER, robot: str = "agilo") -> None:
        self._sequence += 1
        self.model.take(raw_of(key_of(topic, robot), message, sender, self._sequence), self._now_ns())

    def raw(self, raw: Raw) -> None:
        self.model.take(raw, self._now_ns())

    def run(self, seconds: float, without: tuple[str, ...] = (), **messages: m.Message) -> Picture:
        """All parts of a healthy system publish for a while, each at its rate, but for those named in `without`."""
        parts = {"driver": driver(), "odom": m.Odometry(0, 1.0, 2.0, 0.5, 0.1, 0.2), "status": status(), "tick": tick()}
        parts = {name: message for name, message in (parts | messages).items() if name not in without}
        began = self.now_s
        for step in range(round(seconds * 50)):
            self.now_s = began + step * 0.02
            for name, message in parts.items():
                if step % round(50 / TOPICS[name].rate_hz) == 0:
                    self.put(name, message, EXECUTIVE if TOPICS[name].source == "executive" else DRIVER)
        self.now_s = began + seconds
        return self.picture()

    def picture(self) -> Picture:
        return self.model.picture(self._now_ns())

    def _now_ns(self) -> int:
        return round(self.now_s * 1e9)


def problems(picture: Picture) -> list[str]:
    return [finding.problem for finding in picture.problems]
