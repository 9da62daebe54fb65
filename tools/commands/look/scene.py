"""Publish what a robot's package draws: markers and transforms for viewers in 3D (Foxglove, RViz, rerun).

With a recording: write a copy with them. With --live: publish them on the bus for the running executive. With --layout:
write a layout for Foxglove that shows them.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from rich.console import Console
from rich.text import Text

from tailor.runtime.processes.notify import Notifier
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.tools.cli.output_files import beside, check_output, whole_output
from tailor.tools.cli.plain_text import note, plain
from tailor.tools.cli.systems.bus_renewal import BusRun, open_run, opened_anew
from tailor.tools.cli.systems.endpoint import bus_settings, configure_bus, configure_sender, refuse_bus_flags, sender_of
from tailor.tools.recordings.damage_notice import warn
from tailor.tools.scenes.foxglove_layout import layout
from tailor.tools.scenes.live_scenes import publish_scenes
from tailor.tools.scenes.recorded_scenes import add_scenes

EPILOG = """\
examples:
  tailor scene run.mcap                          (writes run-scene.mcap; tailor up records scenes itself)
  tailor scene --live                            (beside a robot of your own, on the bus)
  tailor scene --layout soccer -o soccer.json    (Foxglove: Layouts, Import from file)

rerun reads the transforms of a recording by itself, and the markers by a script of ours:
  python examples/rerun/show_in_rerun.py run.mcap run.rrd && rerun run.rrd"""
NICENESS = 10  # the executive has priority


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor scene`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("recording", type=Path, nargs="?", help="MCAP file")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="new file (default: NAME-scene.mcap)")
    parser.add_argument("--live", action="store_true", help="publish on the bus until interrupted")
    parser.add_argument("--layout", metavar="DOMAIN", help="write Foxglove's layout for a domain's robot")
    configure_sender(parser)
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0; for a recording 1 if it has no run whose robot is known; then there is no new file."""
    if sum((arguments.live, arguments.recording is not None, arguments.layout is not None)) != 1:
        raise UsageError("expected a recording, --live or --layout DOMAIN")
    if arguments.sender and not arguments.live:
        raise UsageError("--sender is the id under which --live publishes, expected it with --live")
    if arguments.output is not None and arguments.live:
        raise UsageError("--live takes no --output: it publishes on the bus, where `tailor record` records it")
    if not arguments.live:
        refuse_bus_flags(arguments)
    if arguments.layout is not None:
        return _layout(arguments)
    return _live(arguments) if arguments.live else _write(arguments)


def _write(arguments: argparse.Namespace) -> int:
    source: Path = arguments.recording
    target: Path = arguments.output or beside(source, "-scene.mcap")
    with Console(stderr=True).status(Text(plain(f"reading {source}"))):
        added, feed, damage = add_scenes(source, target)
    warn(source, damage)
    if feed.fault:
        print(plain(f"the scene of {feed.robot}: {feed.fault}"), file=sys.stderr)
    if not added:
        target.unlink()
    print(plain(f"{target}: {added} messages added" if added else f"{source}: no messages to add; no file is written"))
    return 0 if added else 1


def _layout(arguments: argparse.Namespace) -> int:
    text = json.dumps(layout(arguments.layout), indent=1)
    target: Path = arguments.output or Path(f"{arguments.layout}.foxglove.json")
    check_output("--output", target, (".json",))
    with whole_output(target) as whole:
        whole.write_text(f"{text}\n", encoding="utf-8")
    print(target)
    return 0


def _live(arguments: argparse.Namespace) -> int:
    """Publish the scenes of one run of the bus after another."""
    stop, notifier = stop_on_signals(), Notifier.from_environment()
    if sys.platform == "linux":
        os.nice(NICENESS)

    def opened(sessions: ExitStack) -> BusRun:
        return sessions.enter_context(open_run(arguments, "scene", sender_of(arguments)))

    with ExitStack() as sessions:
        run: BusRun | None = opened(sessions)
        codec.prime()
        if not notifier.supervised:
            note(f"publishing scenes on {bus_settings(arguments).endpoint}; Ctrl-C stops")
        while run is not None:
            publish_scenes(run.session, _ended(run, stop), notifier)
            run = opened_anew(sessions, opened, lambda: stop.requested)
        notifier.stopping()
    return 0


def _ended(run: BusRun, stop: Stop) -> Callable[[], bool]:
    """Whether a stop is requested, or a session with the next run of the bus is due."""
    return lambda: stop.requested or run.due(time.monotonic_ns())
