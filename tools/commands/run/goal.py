"""Send a PDDL goal to the running executive, e.g. "(and (final pos3) (atball pos3))".

The default is the goal of the scenario. --cancel drops the open goal of every executive on the bus: a robot that moves
brakes, and stays armed; one that was stopped stands when people arm it again, instead of going on. In other clients a
goal without conditions, "(and)", does the same.
"""

from __future__ import annotations

import argparse
import json
import sys

from tailor.runtime.bus.service import no_service
from tailor.schemas.errors import UsageError
from tailor.tools.cli.plain_text import plain
from tailor.tools.cli.systems.endpoint import configure_bus, open_bus

NOTHING = "(and)"  # without conditions: drops the open goal
KEY = "exec/goal"
NOBODY = f"{no_service(KEY)}: no executive is running, or it stands still; `tailor status` tells"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor goal`."""
    parser.add_argument("goal", nargs="?", help="PDDL goal (default: the goal of the scenario)")
    parser.add_argument("--cancel", action="store_true", help="drop the open goal, whether the robot is armed or not")
    parser.add_argument("--json", action="store_true", help="print whether it was accepted, and the answer, as JSON")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Send or drop the goal; 0 if every executive accepted that, 2 with the reason if not."""
    if arguments.goal is not None and not arguments.goal.strip():
        raise UsageError("the goal is empty, expected a PDDL goal, or no argument for the goal of the scenario")
    if arguments.cancel and arguments.goal is not None:
        raise UsageError("--cancel: expected without a goal; another goal replaces the open one by itself")
    with open_bus(arguments, "people") as session:
        answers = session.call_all(KEY, NOTHING if arguments.cancel else arguments.goal or "")
    answers = [(accepted, NOBODY if answer == no_service(KEY) else answer) for accepted, answer in answers]
    everyone = all(accepted for accepted, _ in answers)
    if arguments.json:
        print(json.dumps({"accepted": everyone, "answer": "; ".join(answer for _, answer in answers)}))
    else:
        for accepted, answer in answers:
            print(plain(answer), file=sys.stdout if accepted else sys.stderr)
    if len(answers) > 1:
        took = sum(accepted for accepted, _ in answers)
        split = f"{took} accepted it and {len(answers) - took} did not; " if 0 < took < len(answers) else ""
        print(f"{len(answers)} executives answered, expected one: {split}`tailor status` names them", file=sys.stderr)
    return 0 if everyone else 2
