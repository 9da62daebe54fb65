"""Record the bus into an MCAP file that Foxglove, PlotJuggler, rerun and ROS 2 can open.

Ctrl-C or SIGTERM closes the file; kill -9 costs at most the last second. With --snapshot nothing is written before
`tailor record --write` asks for it, an executive comes into FAULT, or a driver stops by itself.
"""

from __future__ import annotations

import argparse
import sys
import time
from contextlib import nullcontext
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

from rich.console import Console
from rich.live import Live

from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.service import ServiceServer
from tailor.runtime.bus.session import Session, open_client
from tailor.runtime.clock import wall_ns
from tailor.runtime.recordings.recorder import Health, Limits, Recorder
from tailor.runtime.recordings.recording_metadata import RecordingMetadata
from tailor.runtime.recordings.selection import selection
from tailor.runtime.recordings.snapshot import SnapshotBuffer
from tailor.runtime.recordings.snapshot_recorder import SnapshotRecorder
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas.errors import UsageError
from tailor.tools.cli.endpoint import configure_bus, endpoint_of
from tailor.tools.cli.number_checks import check_within

TURN_S = 0.1  # so rarely for the sake of the CPU; with FLUSH_NS it bounds what kill -9 costs
MOST = 1e9  # MB or seconds: no disk and no run is so large
GONE = "the bus is gone: nothing is recorded until it is back"
BACK = "the bus is back: recording goes on"
SNAPSHOT_KEY = "recorder/snapshot"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor record`."""
    add = parser.add_argument
    add("-o", "--output", metavar="FILE", help="file to make (default: tailor-DATE-TIME.mcap)")
    add("--topics", action="append", default=[], metavar="WORDS", help="only these: odom, 'agilo/*', a ROS type; a,b,c")
    add("--exclude", action="append", default=[], metavar="WORDS", help="all but these")
    add("--max-size", type=float, metavar="MB", default=0.0, help="go on in a new file after so much")
    add("--max-duration", type=float, metavar="S", default=0.0, help="go on in a new file after so long")
    add("--snapshot", type=float, metavar="S", default=0.0, help="keep the last S seconds in memory, write on demand")
    add("--write", action="store_true", help="ask a running `tailor record --snapshot` to write its file now")
    add("--quiet", action="store_true", help="say nothing while it goes well")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Record until told to stop; 0, or 1 when something was lost."""
    for name in ("max_size", "max_duration", "snapshot"):
        check_within(getattr(arguments, name), MOST, f"--{name.replace('_', '-')}")
    stop = stop_on_signals()
    with open_client(endpoint_of(arguments)) as session:
        if arguments.write:
            done, said = session.call(SNAPSHOT_KEY, "asked for")
            print(said, file=sys.stdout if done else sys.stderr)
            return 0 if done else 1
        intake, subscribe_all = session.subscribe_all("**")
        recorder = _recorder(arguments, intake)
        questions = session.service_server(SNAPSHOT_KEY) if isinstance(recorder, SnapshotRecorder) else None
        _record(recorder, questions, stop, session, quiet=arguments.quiet)
        subscribe_all.undeclare()
        health = recorder.close()
    if not arguments.quiet or health.drops or health.trouble:
        print(_line(health), file=sys.stderr)
    return 1 if health.drops or health.trouble else 0


def _recorder(arguments: argparse.Namespace, intake: IngestQueue) -> Recorder | SnapshotRecorder:
    wanted = selection(arguments.topics, arguments.exclude)
    limits = Limits(round(arguments.max_size * 1e6), round(arguments.max_duration * 1e9))
    path = Path(arguments.output or datetime.now().strftime("tailor-%Y%m%d-%H%M%S.mcap"))
    facts = RecordingMetadata(version("tailor"), wall_ns())
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if arguments.snapshot:
            return SnapshotRecorder(path, intake, wanted, SnapshotBuffer(round(arguments.snapshot * 1e9)), facts)
        return Recorder(path, intake, wanted, limits, facts)
    except FileExistsError as error:
        raise UsageError(f"{error.filename or path}: exists already, expected the name of a new file") from error
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected a place to write to") from error


def _record(
    recorder: Recorder | SnapshotRecorder, questions: ServiceServer | None, stop: Stop, session: Session, quiet: bool
) -> None:
    shown = Live(console=Console(stderr=True), refresh_per_second=4, transient=True)
    with shown if sys.stderr.isatty() and not quiet else nullcontext() as live:
        connected = True
        while not stop.requested:
            recorder.step(time.monotonic_ns())
            if session.connected != connected:
                connected = not connected
                print(BACK if connected else GONE, file=sys.stderr, flush=True)
            if questions is not None and isinstance(recorder, SnapshotRecorder):
                _answer(recorder, questions)
            if live is not None:
                live.update(_line(recorder.health))
            time.sleep(TURN_S)


def _answer(recorder: SnapshotRecorder, questions: ServiceServer) -> None:
    question = questions.poll()
    if question is None:
        return
    if recorder.request_snapshot(question.text, time.monotonic_ns()):
        question.accept("the snapshot will be written")
    else:
        question.refuse("nothing has been heard on the bus yet, so there is nothing to write")


def _line(health: Health) -> str:
    where = health.files[-1] if health.files else "in memory"
    text = f"{where}: {health.messages} messages, {health.bytes / 1e6:.1f} MB"
    if health.drops:
        text += f", {health.drops.total()} dropped"
    return text + (f", disk: {health.trouble}" if health.trouble else "")
