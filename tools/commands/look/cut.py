"""Cut a time span or some topics out of a recording; bytes, metadata and attachments are unchanged."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from tailor.runtime.recordings.copying import copy
from tailor.runtime.recordings.recording import open_recording
from tailor.runtime.recordings.selection import selection
from tailor.schemas.errors import UsageError
from tailor.tools.cli.output_files import beside
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.selection_flags import configure_selection

MAX_S = 1e10  # limit of the clock in the file


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor cut`."""
    add = parser.add_argument
    add("file", help="recording (MCAP)")
    add("-o", "--output", type=Path, metavar="FILE", help="new file (default: NAME-cut.mcap)")
    add(
        "--from", dest="start", type=float, default=0.0, metavar="S", help="seconds after the first message (default 0)"
    )
    add(
        "--to",
        dest="end",
        type=float,
        metavar="S",
        help="seconds after the first message, exclusive (default: the end)",
    )
    configure_selection(parser)
    add("--json", action="store_true", help="print the numbers of messages as JSON")


def run(arguments: argparse.Namespace) -> int:
    """0, or 1 if no message was selected; then there is no new file."""
    if not 0 <= arguments.start < MAX_S:
        raise UsageError(f"--from is {arguments.start:g}, expected seconds from 0 on")
    if arguments.end is not None and not arguments.start < arguments.end < MAX_S:
        raise UsageError(f"--to is {arguments.end:g}, expected more than --from {arguments.start:g}")
    recording = open_recording(arguments.file)
    wanted = selection(arguments.topics, arguments.exclude, everything=True)
    first = next(recording.messages(), None)
    zero_ns = 0 if first is None else first.log_ns
    # the first message need not be the earliest
    start_ns = zero_ns + round(arguments.start * 1e9) if arguments.start else 0
    end_ns = 2**64 if arguments.end is None else zero_ns + round(arguments.end * 1e9)
    target: Path = arguments.output or beside(recording.path, "-cut.mcap")

    def keep(key: str, ros_type: str, log_ns: int) -> bool:
        return start_ns <= log_ns < end_ns and wanted.wants(key, ros_type)

    note = {"from_s": f"{arguments.start:g}", "to_s": "" if arguments.end is None else f"{arguments.end:g}"}
    copied = copy(recording.path, target, keep, note)
    written = str(target) if copied.kept else None
    found = {"output": written, "kept": copied.kept, "left_out": copied.left_out, "damage": copied.damage.text()}
    if arguments.json:
        print(json.dumps(found))
    else:
        if copied.damage.text():
            print(f"{plain(str(recording.path))}: {copied.damage.text()}")
        rest = "" if copied.kept else "; no file is written"
        print(
            f"{plain(written or str(recording.path))}: {copied.kept} messages of {copied.kept + copied.left_out}{rest}"
        )
    return 0 if copied.kept else 1
