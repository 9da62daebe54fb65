"""Send a PDDL goal to the running executive, e.g. "(atball pos3)"; without one, the scenario's own again."""

from __future__ import annotations

import argparse
import sys

from tailor.runtime.bus.session import open_client
from tailor.tools.cli.endpoint import configure_bus, endpoint_of


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor goal`."""
    parser.add_argument("goal", nargs="?", default="", help="PDDL goal (default: the scenario's)")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Ask; 0 when it was accepted, 2 with the reason when not."""
    with open_client(endpoint_of(arguments)) as session:
        accepted, answer = session.ask("exec/goal", arguments.goal)
    print(answer, file=sys.stdout if accepted else sys.stderr)
    return 0 if accepted else 2
