"""Serves the live page until interrupted, across restarts of the bus."""

from __future__ import annotations

import argparse
import os
import sys
from contextlib import ExitStack
from functools import partial

from tailor.runtime.clock import MonotonicClock
from tailor.runtime.stopping import Stop
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.systems.bus_renewal import BusRun, open_run, opened_anew
from tailor.tools.cli.systems.endpoint import bus_settings, open_bus
from tailor.tools.operator.current_button import CurrentButton
from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.live.broadcast import EventBroadcast
from tailor.tools.viewer.live.bus_listener import BusListener
from tailor.tools.viewer.live.server import serving
from tailor.tools.viewer.live.stop_endpoint import StopEndpoint
from tailor.tools.viewer.page import page
from tailor.tools.viewer.timeline import RunTimeline

NICENESS = 10  # the executive has priority over the viewer


class LiveRun:
    """The live page of whatever runs on the bus that the flags select."""

    def __init__(self, arguments: argparse.Namespace, stop: Stop) -> None:
        """`arguments`: parsed flags of `tailor view`; `stop`: request to end."""
        self._arguments, self._stop = arguments, stop
        self._broadcast, self._button = EventBroadcast(), CurrentButton()

    def serve(self) -> None:
        """Serve until a stop is requested.

        Raises:
          UsageError: The port is in use; at the start no router responds, or it refuses this user.
        """
        with ExitStack() as stack:
            sessions = stack.enter_context(ExitStack())
            endpoint, why_none = self._stop_endpoint(sessions)
            document = page("live", (), live=True, stop_token=endpoint.token if endpoint else "")
            port = stack.enter_context(serving(document, self._broadcast, self._arguments.port, endpoint))
            if sys.platform == "linux":  # of this thread and those that it starts, so not of the stop button's
                os.nice(NICENESS)
            codec.prime()
            run: BusRun | None = sessions.enter_context(open_run(self._arguments, "observer"))
            shown = bus_settings(self._arguments).endpoint
            if why_none:  # not earlier: a bus that nobody can open has one error
                print(f"the page has no stop button: {plain(why_none)}", flush=True)
            print(f"http://127.0.0.1:{port}/ shows {shown}; Ctrl-C stops it", flush=True)
            open_again = partial(self._open_again, button=endpoint is not None)
            while run is not None:
                self._listen(sessions, run)
                run = opened_anew(sessions, open_again, lambda: self._stop.requested)

    def _stop_endpoint(self, sessions: ExitStack) -> tuple[StopEndpoint | None, str]:
        """The page's stop button, with a session of its own; None and why where this user may not stop drivers."""
        try:
            self._take_button(sessions)
        except UsageError as error:
            return None, str(error)
        return StopEndpoint(self._button.press, lambda: self._button.connected), ""

    def _take_button(self, sessions: ExitStack) -> None:
        session = sessions.enter_context(open_bus(self._arguments, "people"))
        sessions.enter_context(self._button.of(session))

    def _open_again(self, sessions: ExitStack, button: bool) -> BusRun:
        """Sessions with another run of the bus, whose page begins anew."""
        self._broadcast.beat(0.0, bus=False)  # opening a session takes up to three seconds
        if button:
            self._take_button(sessions)
        run = sessions.enter_context(open_run(self._arguments, "observer"))
        self._broadcast.restart()  # not earlier: an empty page passes for a live one
        return run

    def _listen(self, sessions: ExitStack, run: BusRun) -> None:
        """Follow the bus until a stop is requested or new sessions are due."""
        arguments, session, clock = self._arguments, run.session, MonotonicClock()
        intake, subscription = session.subscribe_all("**")
        sessions.callback(subscription.undeclare)
        explainer = None if arguments.no_models else Explainer()
        timeline, now_ns = RunTimeline(explainer, arguments.robot), clock.now_ns()
        listener = BusListener(
            intake, timeline, self._broadcast, arguments.sender, now_ns, connected=lambda: session.connected
        )
        listener.run(clock, lambda: self._stop.requested or run.due(clock.now_ns()))
