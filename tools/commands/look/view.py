"""Show a run as an HTML page: field, subgoals with alternatives, plan, actions and ticks; recorded or live."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.text import Text

from tailor.runtime.gc_freeze import gc_disabled
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas.errors import UsageError
from tailor.tools.cli.output_files import beside, check_output, whole_output
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.systems.endpoint import configure_bus, refuse_bus_flags
from tailor.tools.viewer.explainer import Explainer
from tailor.tools.viewer.live.live_run import LiveRun
from tailor.tools.viewer.page import page_parts
from tailor.tools.viewer.recorded_events import NOTICE, recorded_events
from tailor.tools.viewer.side_by_side import side_by_side_parts
from tailor.tools.viewer.timeline import Event, RunTimeline

PORT = 7450


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
    if not arguments.live:
        if arguments.port != PORT:
            raise UsageError("--port is that of the live page, expected it with --live")
        refuse_bus_flags(arguments)
        return _write(arguments)
    if arguments.output is not None:
        raise UsageError("--live takes no --output: it serves the page; record the run, and view the recording")
    LiveRun(arguments, stop_on_signals()).serve()
    return 0


def _explainer(arguments: argparse.Namespace) -> Explainer | None:
    return None if arguments.no_models else Explainer()


def _write(arguments: argparse.Namespace) -> int:
    recordings: list[Path] = arguments.recordings
    [first, *others] = recordings
    if repeated := next((path for path in recordings if recordings.count(path) > 1), None):
        raise UsageError(f"{repeated} is there twice, expected each recording once")
    page_of_first = beside(first, ".html")
    output: Path = arguments.output or (page_of_first.with_name("runs.html") if others else page_of_first)
    check_output("--output", output, (".html", ".htm"))
    for path in recordings:
        open_recording(path)  # raises before a folder is made for the page
    runs = {title: _events(path, arguments) for title, path in _titles(recordings).items()}
    [title, *_] = runs
    parts = side_by_side_parts(plain(output.stem), "", runs) if others else page_parts(title, runs[title])
    # the millions of values of an hour hold no cycles; visiting them is a fifth of the work
    with gc_disabled(), whole_output(output) as whole, whole.open("w", encoding="utf-8") as file:
        file.writelines(parts)
    print(output)
    return 0


@contextmanager
def _blamed_on(recording: Path) -> Iterator[None]:
    """Name the recording if it cannot be read on, and not the page that is being written."""
    try:
        yield
    except OSError as error:
        raise UsageError(f"{recording}: {error.strerror or error}, expected a recording that can be read") from error


def _titles(recordings: list[Path]) -> dict[str, Path]:
    """Recordings by printable name; by path only where two have one: a page is passed on, and folders are not."""
    names = Counter(path.name for path in recordings)
    return {plain(path.name if names[path.name] == 1 else str(path)): path for path in recordings}


def _events(recording: Path, arguments: argparse.Namespace) -> Iterator[Event]:
    """Events of a recording, one after another; then what is missing of them is printed."""
    console, explainer = Console(stderr=True), _explainer(arguments)
    timeline, notes = RunTimeline(explainer, arguments.robot), list[str]()
    with console.status(Text(plain(f"reading {recording}"))), _blamed_on(recording):
        for event in recorded_events(recording, timeline, arguments.sender):
            if event.kind == NOTICE:
                notes.append(event.fields["text"])
            yield event
    if timeline.scene_fault:
        notes.append(plain(f"the scene of {timeline.robot}: {timeline.scene_fault}"))
    if explainer is not None and explainer.missing:
        notes.append(plain(f"alternatives are not shown: {explainer.missing}"))
    for note in notes:
        console.print(note, highlight=False, markup=False, soft_wrap=True)
