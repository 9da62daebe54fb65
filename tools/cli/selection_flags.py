"""Flags that select messages, of the bus or of a recording: see `tailor.runtime.recordings.selection`."""

from __future__ import annotations

import argparse


def configure_selection(parser: argparse.ArgumentParser) -> None:
    """Declare --topics and --exclude."""
    topics = "only these: odom, 'agilo/*', a ROS type; or a,b,c"
    parser.add_argument("--topics", action="append", default=[], metavar="WORDS", help=topics)
    parser.add_argument("--exclude", action="append", default=[], metavar="WORDS", help="all except these")
