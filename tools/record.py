"""Record the bus into an MCAP file that Foxglove, PlotJuggler, rerun and ROS 2 can open.

Ctrl-C or SIGTERM closes the file; kill -9 costs at most the last second.
"""

from __future__ import annotations

import argparse
import sys
import time
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

from rich.console import Console
from rich.live import Live

from runtime.clock import wall_ns
from runtime.intake import Intake
from runtime.recorder import Health, Limits, Recorder, recorder_facts
from runtime.selection import Selection, selection
from runtime.session import open_client
from runtime.stopping import stop_on_signals
from schemas.errors import UsageError
from tools.deployment import configure_bus, deployment

TURN_S = 0.02


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor record`."""
    parser.add_argument("-o", "--output", metavar="FILE", help="file to make (default: tailor-DATE-TIME.mcap)")
    parser.add_argument(
        "--topics", action="append", default=[], metavar="WORDS", help="only these: odom, 'agilo/*', a ROS type; a,b,c"
    )
    parser.add_argument("--exclude", action="append", default=[], metavar="WORDS", help="all but these")
    parser.add_argument("--max-size", type=float, metavar="MB", default=0, help="go on in a new file after so much")
    parser.add_argument("--max-duration", type=float, metavar="S", default=0, help="go on in a new file after so long")
    parser.add_argument("--quiet", action="store_true", help="say nothing while it goes well")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Record until told to stop; 0, or 1 when something was lost."""
    wanted = selection(arguments.topics, arguments.exclude)
    limits = Limits(int(arguments.max_size * 1e6), int(arguments.max_duration * 1e9))
    stop = stop_on_signals()
    with open_client(deployment(arguments).bus.endpoint) as session:
        intake = Intake()
        recorder = _recorder(arguments.output, intake, wanted, limits)
        tap = session.tap("**", intake.put)
        live = Live(console=Console(stderr=True), refresh_per_second=4, transient=True)
        with live if sys.stderr.isatty() and not arguments.quiet else _Silent() as shown:
            while not stop.requested:
                recorder.turn(time.monotonic_ns())
                shown.update(_line(recorder.health))
                time.sleep(TURN_S)
        tap.undeclare()
        health = recorder.close()
    if not arguments.quiet or health.drops or health.trouble:
        print(_line(health), file=sys.stderr)
    return 1 if health.drops or health.trouble else 0


def _recorder(output: str | None, intake: Intake, wanted: Selection, limits: Limits) -> Recorder:
    path = Path(output or datetime.now().strftime("tailor-%Y%m%d-%H%M%S.mcap"))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        return Recorder(path, intake, wanted, limits, recorder_facts(version("tailor"), wall_ns()))
    except FileExistsError as error:
        raise UsageError(f"{error.filename or path}: exists already, expected the name of a new file") from error
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected a place to write to") from error


def _line(health: Health) -> str:
    text = f"{health.files[-1]}: {health.messages} messages, {health.bytes / 1e6:.1f} MB"
    if health.drops:
        text += f", {health.drops.total()} dropped"
    return text + (f", disk: {health.trouble}" if health.trouble else "")


class _Silent:
    """Stands in for the live line when nobody looks."""

    def __enter__(self) -> _Silent:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def update(self, line: str) -> None:
        """Shows nothing."""
