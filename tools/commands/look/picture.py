"""Draw recorded runs like the paper's Figure 1: lines across the heading whose length is the speed.

If its name ends in .gif, .webp or .apng, the picture moves: the runs in step from their first actions, in real time, at
most 300 s.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.tools.cli.output_files import check_output, whole_output
from tailor.tools.cli.plain_text import plain

NO_MOTION = "no action was executed, expected a run that moves"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor picture`."""
    parser.add_argument("recording", type=Path, nargs="+", help="MCAP files, drawn side by side")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        default=Path("paths.png"),
        help="PNG, or GIF, WEBP or APNG for a picture that moves (default %(default)s)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Draw the runs and print the path of the picture."""
    from tailor.tools.figures.moving_paths import SUFFIXES, move_paths
    from tailor.tools.figures.paths import draw_paths
    from tailor.tools.figures.recorded_track import recorded_track

    check_output("--output", arguments.output, (".png", *SUFFIXES))
    tracks = [recorded_track(plain(path.stem), path) for path in arguments.recording]
    for path, track in zip(arguments.recording, tracks, strict=True):
        if not track.points:
            why = f"its robot's scene cannot be drawn: {track.scene_fault}" if track.scene_fault else NO_MOTION
            raise UsageError(f"{path}: {why}")
    draw = move_paths if arguments.output.suffix.lower() in SUFFIXES else draw_paths
    with whole_output(arguments.output) as picture:
        draw(tracks, picture)
    print(arguments.output)
    return 0
