"""The live view of a system in a terminal, with its stop key, across restarts of the bus."""

from __future__ import annotations

import argparse
import time
from contextlib import ExitStack
from functools import partial

from rich.console import Console, Group
from rich.live import Live

from tailor.runtime.aside import aside
from tailor.runtime.stopping import Stop
from tailor.schemas import codec
from tailor.tools.cli.keyboard import Keyboard
from tailor.tools.cli.systems.bus_renewal import BusRun, open_run, opened_anew
from tailor.tools.cli.systems.endpoint import bus_settings, open_bus
from tailor.tools.operator.current_button import CurrentButton
from tailor.tools.status.panel import panel
from tailor.tools.status.picture import Picture
from tailor.tools.status.stop_key import StopKey
from tailor.tools.status.system_model import SystemModel
from tailor.tools.status.watcher import Watcher

KEY_S = 0.02  # from a key to the e-stop, at most
DRAW_NS = 250_000_000


class LiveView:
    """Draws the system four times a second, until Ctrl-C or q."""

    def __init__(self, arguments: argparse.Namespace, stop: Stop) -> None:
        """`arguments`: parsed flags of `configure_bus`; `stop`: request to end."""
        self._arguments, self._stop = arguments, stop
        self._endpoint = bus_settings(arguments).endpoint
        self._button = CurrentButton()
        self._key = StopKey(self._button)
        self._model = SystemModel(time.monotonic_ns())
        self._read_ns = 0  # up to which the bus was read

    def run(self) -> Picture:
        """The last state.

        Raises:
          UsageError: At the start no router responds, or it refuses this user.
        """
        with ExitStack() as sessions:
            run: BusRun | None = self._open(sessions)
            codec.prime()
            console = Console(highlight=False, markup=False)
            with (
                Keyboard() as keyboard,
                Live(console=console, screen=True, auto_refresh=False) as live,
                aside(most=1) as self._terminal,
            ):
                while run is not None and not self._watch(run, keyboard, live):
                    run = opened_anew(sessions, self._open, lambda: self._is_to_end(keyboard, live))
                if run is None:  # it ended while a bus was waited for
                    self._key.finish()
            return self._model.picture(self._read_ns)  # not later: nobody is silent since nothing is read

    def _open(self, sessions: ExitStack) -> BusRun:
        """The observer's session, and one of the stop key: a flood of all that is observed must not delay it."""
        run = sessions.enter_context(open_run(self._arguments, "observer"))
        people = sessions.enter_context(open_bus(self._arguments, "people"))
        sessions.enter_context(self._button.of(people))
        return run

    def _is_to_end(self, keyboard: Keyboard, live: Live) -> bool:
        """Whether the view is to end while a bus is waited for; keys are heard, and the state is drawn as it ages."""
        if self._ended(keys := keyboard.read()):
            return True
        self._key.poll(keys)
        self._draw(keyboard, live)
        return False

    def _watch(self, run: BusRun, keyboard: Keyboard, live: Live) -> bool:
        """Whether the view is to end; if not, new sessions are due."""
        drawn_ns, began_ns = 0, time.monotonic_ns()
        self._model, self._read_ns = SystemModel(began_ns), began_ns
        queue, subscription = run.session.subscribe_all("**")
        watcher = Watcher(queue, self._model, began_ns)
        try:
            while not self._ended(keys := keyboard.read()):
                self._key.poll(keys)
                now_ns = time.monotonic_ns()
                if run.due(now_ns):
                    return False
                if now_ns - drawn_ns >= DRAW_NS:
                    drawn_ns = now_ns
                    self._read(watcher, now_ns)
                    self._draw(keyboard, live)
                time.sleep(KEY_S)
            self._key.finish()
            self._read(watcher, time.monotonic_ns())  # what drivers confirmed after a last press
        finally:
            subscription.undeclare()
        return True

    def _read(self, watcher: Watcher, now_ns: int) -> None:
        self._read_ns = now_ns
        watcher.poll(now_ns)

    def _draw(self, keyboard: Keyboard, live: Live) -> None:
        picture = self._model.picture(time.monotonic_ns())
        shown = (self._key.line(picture, keyboard.there), panel(picture, self._endpoint))
        self._terminal.call(partial(live.update, Group(*shown), refresh=True))  # a key never waits for a terminal

    def _ended(self, keys: bytes) -> bool:
        return self._stop.requested or b"q" in keys
