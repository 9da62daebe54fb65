"""Record the bus into an MCAP file that Foxglove, PlotJuggler, rerun and ROS 2 can open.

Ctrl-C or SIGTERM closes the file; kill -9 loses at most the last second. With --snapshot, a file is only written when
`tailor record --write` requests it, an executive enters FAULT, or a driver stops by itself.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from contextlib import nullcontext
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

from rich.console import Console
from rich.live import Live
from rich.text import Text

from tailor.runtime.bus.ingest_queue import IngestQueue
from tailor.runtime.bus.service import ServiceServer, no_service
from tailor.runtime.clock import wall_ns
from tailor.runtime.processes.notify import Notifier
from tailor.runtime.recordings.new_file import EXISTS, check_room
from tailor.runtime.recordings.recorder import Limits, Recorder
from tailor.runtime.recordings.recording_metadata import RecordingMetadata
from tailor.runtime.recordings.selection import Selection, selection
from tailor.runtime.recordings.snapshot import SnapshotBuffer
from tailor.runtime.recordings.snapshot_recorder import SnapshotRecorder
from tailor.runtime.stopping import Stop, stop_on_signals
from tailor.schemas.errors import UsageError
from tailor.tools.cli.number_checks import check_within
from tailor.tools.cli.plain_text import note, plain
from tailor.tools.cli.selection_flags import configure_selection
from tailor.tools.cli.systems.endpoint import bus_settings, configure_bus, configure_sender, open_bus, sender_of
from tailor.tools.recordings import health_text
from tailor.tools.recordings.recorder_bus import RecorderBus

EPILOG = """\
examples:
  tailor record -o run.mcap
  tailor record --topics 'odom,exec/*' --exclude tick
  tailor record -o run.mcap --max-size 100 --max-duration 600      (run_000.mcap, run_001.mcap ...)
  tailor record --snapshot 30                                      (the last 30 s, after a failure, or on request:)
  tailor record --write

A bus must run: tailor bus, or tailor up, which records as well with --record."""
PERIOD_S = 0.1  # long, to save CPU time; with FLUSH_NS it bounds the loss after kill -9
MAX_LIMIT = 1e9  # MB or seconds, beyond any disk and run
SNAPSHOT_KEY = "recorder/snapshot"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor record`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    add = parser.add_argument
    add("-o", "--output", metavar="FILE", help="new file (default: tailor-DATE-TIME.mcap)")
    configure_selection(parser)
    add("--max-size", type=float, metavar="MB", default=0.0, help="begin a new file at this size")
    add("--max-duration", type=float, metavar="S", default=0.0, help="begin a new file after this time")
    add("--snapshot", type=float, metavar="S", default=0.0, help="keep the last S seconds in memory, write on request")
    add("--write", action="store_true", help="request that a running `tailor record --snapshot` writes its file now")
    add("--quiet", action="store_true", help="print nothing unless something is lost")
    add("--json", action="store_true", help="print the files and numbers of messages as JSON at the end")
    configure_sender(parser)
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Record until stopped; 0, or 1 if something was lost."""
    for name in ("max_size", "max_duration", "snapshot"):
        check_within(getattr(arguments, name), MAX_LIMIT, f"--{name.replace('_', '-')}")
    _check_flags(arguments)
    wanted = selection(arguments.topics, arguments.exclude)
    stop, notifier = stop_on_signals(), Notifier.from_environment()
    if arguments.write:
        return _write(arguments)
    bus = RecorderBus(arguments, SNAPSHOT_KEY if arguments.snapshot else "")
    with bus.opened():
        recorder = _recorder(arguments, bus.queue, wanted, waits_for_room=notifier.supervised)
        if not (arguments.quiet or notifier.supervised):
            note(_beginning(arguments), to_stderr=True)
        notifier.ready()
        _record(recorder, bus, stop, notifier, quiet=arguments.quiet)
        notifier.stopping()
        health = recorder.close()  # before the session, which takes ten seconds to close while its router hangs
    if arguments.json:
        print(json.dumps(health_text.json_value(health)), flush=True)
    elif not arguments.quiet or health.drops or health.unwritten or health.mixed or health.disk_error:
        print(health_text.line(health), file=sys.stderr)
    return 1 if health.drops or health.unwritten or health.disk_error else 0


def _check_flags(arguments: argparse.Namespace) -> None:
    """Raise UsageError if a flag is given that the others leave no use for."""
    split = ("max_size", "max_duration")
    of_files = ("output", "topics", "exclude", "snapshot", *split)
    for given, others in (("write", of_files), ("snapshot", split)):
        ignored = [f"--{name.replace('_', '-')}" for name in others if getattr(arguments, name)]
        if getattr(arguments, given) and ignored:
            raise UsageError(f"--{given} takes no {', '.join(ignored)} (see tailor record --help)")


def _write(arguments: argparse.Namespace) -> int:
    """Request a snapshot; 0 if it is accepted, 1 if it is declined, 2 if nobody keeps one."""
    with open_bus(arguments, "people", sender=sender_of(arguments)) as session:
        accepted, response = session.call(SNAPSHOT_KEY, "requested")
    absent = response == no_service(SNAPSHOT_KEY)
    if absent:
        response += ", expected a running `tailor record --snapshot S`"
    if arguments.json:
        print(json.dumps({"accepted": accepted, "answer": response}))
    else:
        print(plain(response), file=sys.stdout if accepted else sys.stderr)
    return 0 if accepted else 2 if absent else 1


def _recorder(
    arguments: argparse.Namespace, queue: IngestQueue, wanted: Selection, waits_for_room: bool
) -> Recorder | SnapshotRecorder:
    """The recorder; on a full disk a person's is refused, but a service would not be started again."""
    limits = Limits(round(arguments.max_size * 1e6), round(arguments.max_duration * 1e9))
    named: str | None = arguments.output
    path = Path(datetime.now().strftime("tailor-%Y%m%d-%H%M%S.mcap") if named is None else named)
    if not path.name:
        raise UsageError(f"--output {path}: is a folder, expected the name of a new file")
    metadata = RecordingMetadata(version("tailor"), wall_ns())
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if not waits_for_room:
            check_room(path.parent)
        if arguments.snapshot:
            return SnapshotRecorder(path, queue, wanted, SnapshotBuffer(round(arguments.snapshot * 1e9)), metadata)
        return Recorder(path, queue, wanted, limits, metadata)
    except FileExistsError as error:
        raise UsageError(EXISTS.format(error.filename or path)) from error
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected a writable path") from error


def _record(
    recorder: Recorder | SnapshotRecorder, bus: RecorderBus, stop: Stop, notifier: Notifier, quiet: bool
) -> None:
    shown = Live(console=Console(stderr=True), refresh_per_second=4, transient=True)
    with shown if sys.stderr.isatty() and not quiet else nullcontext() as live:
        connected, status = True, ""
        while not stop.requested:
            recorder.step(time.monotonic_ns())
            bus.renew(time.monotonic_ns())
            if bus.connected != connected:
                connected = not connected
                note(health_text.RECONNECTED if connected else health_text.DISCONNECTED, to_stderr=True)
            notifier.alive()
            if (losses := health_text.losses(recorder.health, connected)) != status:
                status = losses
                notifier.status(status)
            if bus.requests is not None and isinstance(recorder, SnapshotRecorder):
                _serve(recorder, bus.requests)
            if live is not None:
                live.update(Text(plain(health_text.line(recorder.health))))
            time.sleep(PERIOD_S)


def _serve(recorder: SnapshotRecorder, requests: ServiceServer) -> None:
    request = requests.poll()
    if request is None:
        return
    if recorder.request_snapshot(request.text, time.monotonic_ns()):
        request.accept("the snapshot will be written")
    else:
        request.refuse("no message has been received yet, so there is nothing to write")


def _beginning(arguments: argparse.Namespace) -> str:
    what = f"the last {arguments.snapshot:g} s, in memory" if arguments.snapshot else "into a file"
    return f"recording {what}, waiting for messages on {bus_settings(arguments).endpoint}; Ctrl-C ends it"
