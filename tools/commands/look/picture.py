"""Draw recorded runs like the paper's Figure 1: lines across the heading whose length is the speed."""

from __future__ import annotations

import argparse
from pathlib import Path


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor picture`."""
    parser.add_argument("recording", type=Path, nargs="+", help="MCAP files, drawn side by side")
    parser.add_argument("-o", "--output", type=Path, default=Path("paths.png"), help="PNG (default %(default)s)")


def run(arguments: argparse.Namespace) -> int:
    """Draw the runs and print the path of the picture."""
    from tailor.tools.figures.paths import draw_paths
    from tailor.tools.figures.recorded_track import recorded_track

    draw_paths([recorded_track(path.stem, path) for path in arguments.recording], arguments.output)
    print(arguments.output)
    return 0
