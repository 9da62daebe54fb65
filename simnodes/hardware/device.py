"""Runs a Hardware in threads of its own, so that no call of it delays the guard.

One thread opens and closes, one reads, one writes. The driver's loop looks at them once a period and never waits: a
call that stalls is a fault like one that raises. After a fault standstill is written once more, if `write` still
answers; then the hardware is closed, and opened again by the retry policy.
"""

from __future__ import annotations

import math
import threading
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from enum import Enum

from tailor.runtime.clock import Clock
from tailor.schemas.messages import Message
from tailor.simnodes.guard import Limit
from tailor.simnodes.hardware.calls import Calls, fault_text
from tailor.simnodes.hardware.interface import Hardware
from tailor.simnodes.hardware.watchdogs import RetryPolicy

SILENT_LOOP_NS = 300_000_000  # without a set-point for so long, the loop hangs: standstill is written
CLOSE_S = 5.0  # a call of `close` that takes longer is reported
IDLE_S = 0.002  # after a read without a measurement
MAX_READINGS = 256  # that wait for the loop


class Phase(Enum):
    """What the hardware is doing."""

    OPENING = "opening"
    RUNNING = "running"
    CLOSING = "closing"
    WAITING = "waiting"  # to be opened again
    ENDED = "ended"


class Device:
    """Hardware that is opened, read, written and closed in the background.

    Attributes:
      phase: What it is doing.
      opening: Number of the newest opening.
      fault: First fault since the newest opening that had any, one line; empty since the hardware runs again.
      notice: The hardware's notice at its newest `read`, one line.
    """

    def __init__(self, hardware: Hardware, limits: Sequence[Limit], retry: RetryPolicy, clock: Clock) -> None:
        """Nothing is called before `start`; the limits name the axes that keep their set-points at standstill."""
        self.phase, self.opening, self.fault, self.notice = Phase.OPENING, 0, "", ""
        self._hardware, self._retry, self._clock = hardware, retry, clock
        limits_s = {"open": hardware.open_s, "read": hardware.read_s, "write": hardware.write_s, "close": CLOSE_S}
        self._calls = Calls(clock, limits_s)
        self._measured: dict[str, Message] = {}  # newest of each topic
        self._readings: deque[tuple[int, Mapping[str, Message]]] = deque(maxlen=MAX_READINGS)
        self._keeps = tuple(limit.kept is not None for limit in limits)
        self._values, self._handed_ns = tuple(limit.kept or 0.0 for limit in limits), clock.now_ns()
        self._kept: tuple[float, ...] | None = None  # newest set-points of axes that stay as they are
        self._follows = any(self._keeps) and type(hardware).kept is not Hardware.kept
        self._awaits_kept = self._follows  # the present set-points would move such an axis, e.g. close an open gripper
        self._at_rest = True  # nothing was written, or standstill last
        self._handing = threading.Lock()  # held for microseconds
        self._ended, self._broken = threading.Event(), threading.Event()
        self._faults, self._opened_ns, self._closed, self._failed = 0, 0, False, False
        self._main = threading.Thread(target=self._live, name="hardware", daemon=True)

    def start(self) -> None:
        """Begin to open the hardware."""
        self._main.start()

    def end(self, timeout_s: float = 2.0) -> bool:
        """Write the set-points for standstill, close, and wait for that; whether it was done in time."""
        self._ended.set()
        self._broken.set()
        self._main.join(timeout_s)
        return not self._main.is_alive()

    def readings(self) -> list[tuple[int, Mapping[str, Message]]]:
        """Measurements since the last call, oldest first, with the monotonic time of their arrival."""
        waiting = []
        while self._readings:
            waiting.append(self._readings.popleft())
        return waiting

    @property
    def kept(self) -> Callable[[], Sequence[float]] | None:
        """Set-points at which axes that keep theirs stay as they are; None: unknown."""
        kept = self._kept
        return None if kept is None else lambda: kept

    def hand(self, values: tuple[float, ...], now_ns: int, may_move: bool = True, opening: int | None = None) -> None:
        """Set the set-points that are written from now on.

        Args:
          values: Set-points.
          now_ns: Monotonic time.
          may_move: Whether an axis that keeps its set-point may move by them: the robot is armed, or stays as it is.
          opening: For which they were made; those for one of before are dropped. None: the newest.
        """
        with self._handing:
            if opening in (None, self.opening):
                self._values, self._handed_ns = values, now_ns
                self._awaits_kept = self._awaits_kept and not may_move

    def fail(self, fault: str) -> None:
        """A watchdog of the loop found a fault."""
        if not self._failed:  # what follows from a fault is none of its own
            self._failed, self.fault = True, fault_text(fault)
        self._broken.set()

    def stalled(self, now_ns: int) -> str:
        """A call that has taken longer than its limit, as text; empty if there is none."""
        return self._calls.stalled(now_ns)

    def _live(self) -> None:
        while not self._ended.is_set():
            self._run_once()
            if self._ended.is_set():
                break
            if self._clock.now_ns() - self._opened_ns > self._retry.most_s * 1e9:
                self._faults = 0
            self._faults += 1
            pause_s = self._retry.pause_s(self._faults)
            if pause_s is None:
                break
            self.phase = Phase.WAITING
            self._ended.wait(pause_s)
        self.phase = Phase.ENDED

    def _run_once(self) -> None:
        """Open, work until a fault, close."""
        self.phase, self._closed, self._failed = Phase.OPENING, False, False
        self._broken.clear()
        if self._ended.is_set():  # since a moment ago: its own `set` may have been cleared
            return
        fault = self._calls.made("open", self._hardware.open)
        self._opened_ns = self._clock.now_ns()
        if fault:
            self.fail(fault)
        elif not self._broken.is_set():  # it may have stalled for longer than a watchdog allows
            self._work()
        self.phase = Phase.CLOSING
        self._close()

    def _work(self) -> None:
        self.fault = self.notice = ""
        with self._handing:
            self.opening += 1
            self._values = self._standstill()  # nothing from before the fault, should the loop hang
            self._handed_ns = self._clock.now_ns()
            self._kept, self._awaits_kept = None, self._follows and self._at_rest  # to stop the robot comes first
        self._readings.clear()
        self.phase = Phase.RUNNING
        threads = [threading.Thread(target=each, daemon=True) for each in (self._read, self._write)]
        for thread in threads:
            thread.start()
        self._broken.wait()
        self.phase = Phase.CLOSING
        for thread, limit_s in zip(threads, (self._hardware.read_s, 2 * self._hardware.write_s), strict=True):
            thread.join(limit_s)
        if any(thread.is_alive() for thread in threads):
            self._close()  # ends a call that waits
        for thread in threads:
            thread.join()  # a device is never opened while a thread is still inside it

    def _close(self) -> None:
        if not self._closed:
            self._closed = True
            self._calls.made("close", self._hardware.close)

    def _read(self) -> None:
        def take() -> None:
            measured = self._hardware.read()
            self.notice = fault_text(self._hardware.notice)
            if measured and not isinstance(measured, Mapping):
                raise TypeError(f"returned {type(measured).__name__}, expected messages by topic")
            if new := self._new(measured or {}):
                self._follow()
                self._readings.append((self._clock.now_ns(), new))
            else:
                self._ended.wait(IDLE_S)

        self._repeat("read", take)

    def _new(self, measured: Mapping[str, Message]) -> dict[str, Message]:
        """The measurements that were not read before, in a mapping that no later read fills again."""
        new = {name: each for name, each in measured.items() if not _repeats(each, self._measured.get(name))}
        self._measured |= new
        return new

    def _follow(self) -> None:
        kept = self._hardware.kept()
        if kept is not None and (len(kept) != len(self._keeps) or not all(map(math.isfinite, kept))):
            raise ValueError(f"kept returned {kept}, expected {len(self._keeps)} numbers")
        self._kept = self._kept if kept is None else tuple(kept)

    def _write(self) -> None:
        period_ns, due_ns = round(1e9 / self._hardware.write_hz), 0
        last: tuple[float, ...] = ()

        def give() -> None:
            nonlocal due_ns, last
            now_ns = self._clock.now_ns()
            values = self._values if now_ns - self._handed_ns <= SILENT_LOOP_NS else self._standstill()
            if not self._awaits_kept and (values != last or now_ns >= due_ns):
                due_ns, last, self._at_rest = now_ns + period_ns, values, False
                self._hardware.write(values)

        self._repeat("write", give, pause_s=0.005)
        if not self._awaits_kept:
            self._at_rest = not self._calls.made("write", lambda: self._hardware.write(self._standstill()))

    def _standstill(self) -> tuple[float, ...]:
        return tuple(value if keeps else 0.0 for value, keeps in zip(self._values, self._keeps, strict=True))

    def _repeat(self, name: str, call: Callable[[], None], pause_s: float = 0.0) -> None:
        while not self._broken.is_set():
            fault = self._calls.made(name, call)
            if fault:
                self.fail(fault)
            elif pause_s:
                self._broken.wait(pause_s)


def _repeats(message: Message, before: Message | None) -> bool:
    """Whether a message is the one of before, e.g. since a class returns what its device's thread has left there."""
    return message is before or (bool(getattr(message, "stamp_ns", 0)) and message == before)
