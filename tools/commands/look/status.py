"""Show the state of a running system: modes with reasons, freshness, tick timing, guard counters, foreign messages.

In a terminal the view is live; s or space stops every driver at once, q ends the view. In a pipe, or with --json, the
state is printed once. Exit code 0: healthy; 1: not; 2: bad input, or no router responds.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from dataclasses import asdict

from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UnreachableError, UsageError
from tailor.tools.cli.number_checks import finite
from tailor.tools.cli.systems.endpoint import bus_settings, configure_bus, open_bus
from tailor.tools.cli.terminal import table_console
from tailor.tools.status.live_view import LiveView
from tailor.tools.status.panel import panel
from tailor.tools.status.picture import Picture
from tailor.tools.status.system_model import SystemModel
from tailor.tools.status.watcher import Watcher

OBSERVE_S = 1.5  # every periodic topic comes at least once, state and odometry more often
MIN_S, MAX_S = 0.2, 3600.0
COMPLETE_S = 1.2  # by then executive and launcher have published what they do once a second
NICENESS = 10  # the executive has priority over the observer
DRAIN_S = 0.05


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor status`."""
    parser.add_argument("--json", action="store_true", help="print one JSON object (docs/deployment.md)")
    parser.add_argument(
        "--seconds",
        type=finite("--seconds"),
        metavar="S",
        help=f"observe for S seconds, then print the state once (default in a pipe: {OBSERVE_S:g})",
    )
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 if the system is healthy at the end, 1 if not."""
    live = sys.stdout is not None and sys.stdout.isatty() and not arguments.json and arguments.seconds is None
    seconds = OBSERVE_S if arguments.seconds is None else arguments.seconds
    if not MIN_S <= seconds <= MAX_S:
        raise UsageError(f"--seconds is {seconds:g}, expected {MIN_S:g} to {MAX_S:g}")
    endpoint, stop = bus_settings(arguments).endpoint, stop_on_signals()
    picture = LiveView(arguments, stop).run() if live else _once(arguments, seconds, stop)
    if arguments.json:
        print(json.dumps(asdict(picture), allow_nan=False))
    else:
        table_console().print(panel(picture, endpoint))
    return 0 if picture.healthy else 1


def _once(arguments: argparse.Namespace, seconds: float, stop: Stop) -> Picture:
    with open_bus(arguments, "observer") as session:
        os.nice(NICENESS)
        codec.prime()
        queue, subscription = session.subscribe_all("**")
        began_ns = time.monotonic_ns()
        model = SystemModel(began_ns)
        picture = _observe(model, Watcher(queue, model, began_ns), seconds, stop)
        subscription.undeclare()
        if not session.connected and not stop.requested:  # else it would seem that nobody is there
            raise UnreachableError(f"bus endpoint {bus_settings(arguments).endpoint}: was lost while it was observed")
        return picture


def _observe(model: SystemModel, watcher: Watcher, seconds: float, stop: Stop) -> Picture:
    """The state after some seconds; after `COMPLETE_S` where less left open what is required, or launched."""
    began_s, polled_ns = time.monotonic(), time.monotonic_ns()
    while not stop.requested:
        elapsed_s = time.monotonic() - began_s
        if elapsed_s >= seconds and not (elapsed_s < COMPLETE_S and model.incomplete(time.monotonic_ns())):
            break
        time.sleep(DRAIN_S)
        polled_ns = time.monotonic_ns()
        watcher.poll(polled_ns)
    return model.picture(polled_ns)  # not later: what arrived since has not been read, and nobody was silent
