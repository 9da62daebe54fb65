"""A dead man's switch held by a terminal: while it runs it repeats a message, and its silence stops every driver.

The message goes out from the same loop that watches the terminal, so a frozen terminal, process or machine is a
release. See tailor.simnodes.hold for the driver's half.
"""

from __future__ import annotations

import select
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import TextIO

from tailor.runtime.bus.session import Session
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.loop import Loop
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas.codec import decode, encode
from tailor.schemas.messages import DriverState
from tailor.schemas.own import example
from tailor.schemas.reason_text import reason_text
from tailor.simnodes.driver import HELD_BY, shown
from tailor.simnodes.hold import RELEASED_NS
from tailor.tools.cli.keyboard import Keyboard
from tailor.tools.cli.plain_text import plain
from tailor.tools.operator.stop_button import DriverStates, driver_states

HELD = b"\0\1\0\0\0"  # CDR of EStop(False)
PERIOD_NS = 100_000_000
SILENT_NS = 500_000_000  # of a driver: five states
SETTLING_NS = 500_000_000  # after the start nothing is reported: drivers have not heard of the switch yet
ABOUT = f"""\
This terminal holds a dead man's switch. Every driver that hears it stops and latches {RELEASED_NS / 1e9:g} s after this
program falls silent, however it ends. Press any key, or Ctrl-C, to stop every driver at once."""


class DeadMansSwitch:
    """Publishes that the switch is held, once a period, and reports what each driver makes of it."""

    def __init__(self, session: Session, report: Callable[[str], None]) -> None:
        """`session`: of a role that may publish the e-stop; `report`: receives a line at each change."""
        self._session, self._report = session, report
        self._publisher = session.publisher("estop", "")
        self._heard_ns: dict[str, int] = {}  # when each driver was heard last
        self._lines: dict[str, str] = {}

    def hold(self, released: Callable[[], bool]) -> None:
        """Hold the switch until `released()` is true, or the bus has been away for as long as drivers wait."""
        decode(DriverState, encode(example(DriverState)))  # the first use takes up to 0.4 s: no pause between messages
        clock = MonotonicClock()
        began_ns = connected_ns = clock.now_ns()
        loop = Loop(PERIOD_NS, clock)
        with driver_states(self._session) as states:
            while not released():
                self._publisher.publish_encoded(HELD)
                now_ns = loop.wait_for_next_period().now_ns
                connected_ns = now_ns if self._session.connected else connected_ns
                if now_ns - connected_ns > RELEASED_NS:
                    self._report("the bus is gone: drivers have stopped, since they no longer hear this switch")
                    return
                self._hear(states, now_ns)
                if now_ns - began_ns > SETTLING_NS:
                    self._show(states, now_ns)

    def _hear(self, states: DriverStates, now_ns: int) -> None:
        self._heard_ns |= dict.fromkeys(states.poll(), now_ns)

    def _show(self, states: DriverStates, now_ns: int) -> None:
        silent = {robot for robot, at_ns in self._heard_ns.items() if now_ns - at_ns > SILENT_NS}
        switch = shown(self._session.sender)
        deaf_first = {robot: min(each, key=lambda state: _hears(state, switch)) for robot, each in states.all().items()}
        lines = driver_lines(deaf_first, switch, silent)
        for robot, line in lines.items():
            if self._lines.get(robot) != line:
                self._report(line)
        self._lines = lines


def driver_lines(states: Mapping[str, DriverState], switch: str, silent: set[str]) -> dict[str, str]:
    """By robot, one line on its driver.

    Args:
      states: Newest state of each robot's driver; of several drivers that of one that does not hear the switch, if any.
      switch: Short form of this switch's sender id.
      silent: Robots whose driver has not been heard for a while.
    """
    lines = {}
    for robot, state in sorted(states.items()):
        detail, held_by, _ = state.detail.rpartition(HELD_BY)
        cause = reason_text(state.reason, detail.removesuffix("; ") if held_by else state.detail)
        text = f"{robot} is {state.mode}" + (f" ({cause})" if cause else "")
        text += ": hears this switch" if _hears(state, switch) else ": DOES NOT HEAR THIS SWITCH"
        lines[robot] = plain(f"{robot} is SILENT: its state is unknown" if robot in silent else text)
    return lines


def _hears(state: DriverState, switch: str) -> bool:
    _, held_by, holders = state.detail.rpartition(HELD_BY)
    return bool(held_by) and switch in holders.split(", ")


def hold_in_terminal(session: Session, output: TextIO) -> None:
    """Hold the switch until a key is pressed, a signal arrives, or standard input or the terminal is closed.

    Args:
      session: With the bus.
      output: Takes what people read.
    """
    stop = stop_on_signals()
    with Keyboard() as keyboard:

        def released() -> bool:
            keyboard.take()
            if stop.requested or not _readable():
                return stop.requested
            with suppress(OSError):  # a terminal that has gone
                keyboard.read()  # or the key would be the shell's
            return True

        print(ABOUT, file=output, flush=True)
        DeadMansSwitch(session, lambda line: print(line, file=output, flush=True)).hold(released)


def _readable() -> bool:
    """Whether standard input has a key, a line or its end to read; without one nobody holds anything."""
    return sys.stdin is None or sys.stdin.closed or bool(select.select([sys.stdin], [], [], 0)[0])
