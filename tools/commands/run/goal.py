"""Send a PDDL goal to the running executive, e.g. "(atball pos3)"; the default is the goal of the scenario."""

from __future__ import annotations

import argparse
import sys

from tailor.tools.cli.endpoint import configure_bus, open_bus


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor goal`."""
    parser.add_argument("goal", nargs="?", default="", help="PDDL goal (default: the goal of the scenario)")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Send the goal; 0 if the executive accepted it, 2 with the reason if not."""
    with open_bus(arguments, "people") as session:
        accepted, answer = session.call("exec/goal", arguments.goal)
    print(answer, file=sys.stdout if accepted else sys.stderr)
    return 0 if accepted else 2
