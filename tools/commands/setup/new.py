"""Write the package of a new robot: a complete, running start, which you change into your own."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from tailor.tools.new_robot.templates import kinds, write_robot

EPILOG = """\
examples:
  tailor new robot courier                 writes courier/: a wheeled robot that drives from station to station
  tailor new robot painter --kind arm --into ~/robots

Then, in the new folder:
  pip install -e '.[test]'                 now every command knows the robot, and pytest tests it
  tailor gather courier && tailor train courier
  tailor up courier --once

Its README.md states what to change first; docs/new-robot.md is the tutorial."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor new`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("what", choices=["robot"], help="what to write: robot")
    parser.add_argument("name", metavar="NAME", help="name of the robot: lower-case letters, digits, inner - and _")
    parser.add_argument("--kind", choices=kinds(), default="wheeled", help="kind of robot (default: %(default)s)")
    parser.add_argument(
        "--into", type=Path, default=Path(), metavar="DIR", help="folder in which NAME/ is made (default: this one)"
    )
    parser.add_argument("--json", action="store_true", help="print the folder and its number of files as JSON")


def run(arguments: argparse.Namespace) -> int:
    """Write it; exit code 0."""
    name = arguments.name
    folder = write_robot(name, arguments.kind, arguments.into)
    count = sum(path.is_file() for path in folder.rglob("*"))
    if arguments.json:
        print(json.dumps({"folder": str(folder), "files": count}))
        return 0
    print(f"{folder}: {count} files. Next: cd {folder} && pip install -e '.[test]' && tailor gather {name}")
    return 0
