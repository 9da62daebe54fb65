"""Show a run as an HTML page: field, subgoals with alternatives, plan, actions and ticks; recorded or live."""

from __future__ import annotations

import argparse
import os
import sys
from contextlib import ExitStack
from pathlib import Path

from rich.console import Console

from tailor.runtime.clock import MonotonicClock
from tailor.runtime.gc_freeze import gc_disabled
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.tools.cli.endpoint import bus_settings, configure_bus, open_bus
from tailor.tools.cli.output_files import check_output
from tailor.tools.cli.plain_text import plain
from tailor.tools.operator.stop_button import StopButton
from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.live.broadcast import EventBroadcast
from tailor.tools.viewer.live.bus_listener import BusListener
from tailor.tools.viewer.live.server import serving
from tailor.tools.viewer.live.stop_endpoint import StopEndpoint
from tailor.tools.viewer.page import page
from tailor.tools.viewer.recorded_messages import recorded_events
from tailor.tools.viewer.side_by_side import side_by_side
from tailor.tools.viewer.timeline import Event, RunTimeline

PORT = 7450
NICENESS = 10  # the executive has priority over the viewer


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor view`."""
    parser.add_argument(
        "recordings",
        type=Path,
        nargs="*",
        metavar="recording",
        help="MCAP file; the page is one file and needs no server. Several are shown side by side, in step",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="HTML",
        help="the page (default: beside the recording; of several: runs.html)",
    )
    parser.add_argument("--live", action="store_true", help="serve the page of a running system on this machine")
    parser.add_argument(
        "--port", type=int, default=PORT, help="port of the live page; 0 finds a free one (default %(default)s)"
    )
    parser.add_argument("--robot", default="", help="show only this robot (default: the executive's)")
    parser.add_argument("--sender", default="", metavar="ID", help="show only executives whose id begins with ID")
    parser.add_argument("--no-models", action="store_true", help="do not load models; alternatives are not shown")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Write the page of a recording, or serve the live page until interrupted."""
    if arguments.live == bool(arguments.recordings):
        raise UsageError("expected either recordings or --live")
    if not 0 <= arguments.port < 65536:
        raise UsageError(f"--port is {arguments.port}, expected 0 to 65535")
    return _live(arguments) if arguments.live else _write(arguments)


def _explainer(arguments: argparse.Namespace) -> Explainer | None:
    return None if arguments.no_models else Explainer()


def _write(arguments: argparse.Namespace) -> int:
    recordings: list[Path] = arguments.recordings
    [first, *others] = recordings
    output: Path = arguments.output or (first.with_name("runs.html") if others else first.with_suffix(".html"))
    check_output("--output", output, (".html", ".htm"))
    with gc_disabled():  # the millions of values of an hour hold no cycles; visiting them is a fifth of the work
        runs = {str(path) if others else path.name: _events(path, arguments) for path in recordings}
        text = side_by_side(output.stem, "", runs) if others else page(first.name, runs[first.name])
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{output}: {error.strerror}, expected a file that can be written") from error
    print(output)
    return 0


def _events(recording: Path, arguments: argparse.Namespace) -> list[Event]:
    console, explainer = Console(stderr=True), _explainer(arguments)
    with console.status(f"reading {recording}"):
        events = recorded_events(recording, RunTimeline(explainer, arguments.robot), arguments.sender)
    if explainer is not None and explainer.missing:
        console.print(f"alternatives are not shown: {explainer.missing}", highlight=False)
    return events


def _live(arguments: argparse.Namespace) -> int:
    endpoint = bus_settings(arguments).endpoint
    stop = stop_on_signals()
    broadcast = EventBroadcast()
    with ExitStack() as stack:
        button = _stop_endpoint(arguments, stack)
        document = page("live", (), live=True, stop_token=button.token if button else "")
        port = stack.enter_context(serving(document, broadcast, arguments.port, button))
        if sys.platform == "linux":  # of this thread and those that it starts, so not of the stop button's
            os.nice(NICENESS)
        session = stack.enter_context(open_bus(arguments, "observer"))
        codec.prime()
        intake, subscribe_all = session.subscribe_all("**")
        timeline, clock = RunTimeline(_explainer(arguments), arguments.robot), MonotonicClock()
        listener = BusListener(intake, timeline, broadcast, arguments.sender, clock.now_ns())
        print(f"http://127.0.0.1:{port}/ shows {endpoint}; Ctrl-C stops it", flush=True)
        listener.run(clock, lambda: stop.requested)
        subscribe_all.undeclare()
    return 0


def _stop_endpoint(arguments: argparse.Namespace, stack: ExitStack) -> StopEndpoint | None:
    """The page's stop button, with a session of its own; None where this user may not stop drivers."""
    try:
        session = stack.enter_context(open_bus(arguments, "people"))
    except UsageError as error:
        print(f"the page has no stop button: {plain(str(error))}", flush=True)
        return None
    return StopEndpoint(StopButton(session).press)
