"""Send a PDDL goal to the running executive, e.g. "(and (final pos3) (atball pos3))".

The default is the goal of the scenario. "(and)", which holds at once, drops the goal: before a stopped robot is armed
again, say, which would go on with it.
"""

from __future__ import annotations

import argparse
import json
import sys

from tailor.schemas.errors import UsageError
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.systems.endpoint import configure_bus, open_bus


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor goal`."""
    parser.add_argument("goal", nargs="?", help="PDDL goal (default: the goal of the scenario)")
    parser.add_argument("--json", action="store_true", help="print whether it was accepted, and the answer, as JSON")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Send the goal; 0 if the executive accepted it, 2 with the reason if not."""
    if arguments.goal is not None and not arguments.goal.strip():
        raise UsageError("the goal is empty, expected a PDDL goal, or no argument for the goal of the scenario")
    with open_bus(arguments, "people") as session:
        accepted, answer = session.call("exec/goal", arguments.goal or "")
    if arguments.json:
        print(json.dumps({"accepted": accepted, "answer": answer}))
    else:
        print(plain(answer), file=sys.stdout if accepted else sys.stderr)
    return 0 if accepted else 2
