"""Send a PDDL goal to the running executive, e.g. "(and (final pos3) (atball pos3))".

The default is the goal of the scenario. --wait prints what the executive does until the goal has ended: exit code 0 if
it was achieved, 1 if not. --cancel drops the open goal of every executive on the bus: a robot that moves brakes, and
stays armed; one that was stopped stands when people arm it again, instead of going on. In other clients a goal without
conditions, "(and)", does the same.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import asdict

from tailor.runtime.bus.service import ACCEPTED, no_service
from tailor.runtime.stopping import stoppable
from tailor.schemas.errors import UsageError
from tailor.schemas.reason_text import result_text
from tailor.schemas.services import DROP
from tailor.tools.cli.number_checks import finite
from tailor.tools.cli.plain_text import note, plain
from tailor.tools.cli.systems.endpoint import configure_bus, key_advice, open_bus
from tailor.tools.operator.goal_follower import PURSUED, GoalFollower

KEY = "exec/goal"
NOBODY = f"{no_service(KEY)}: no executive is running, or it stands still; `tailor status` tells"
LOST = "the bus was lost before an answer came: the request may count or not; `tailor status` shows the goal"


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor goal`."""
    parser.add_argument("goal", nargs="?", help="PDDL goal (default: the goal of the scenario)")
    parser.add_argument("--wait", action="store_true", help="wait until it is achieved (0), or has ended otherwise (1)")
    parser.add_argument("--timeout", type=finite("--timeout"), metavar="S", help="with --wait: for at most S seconds")
    parser.add_argument("--cancel", action="store_true", help="drop the open goal, whether the robot is armed or not")
    parser.add_argument(
        "--json", action="store_true", help="print the answer as JSON, with --wait also what became of the goal"
    )
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Send or drop the goal: 0 if every executive accepted that, 2 with the reason if not; --wait has its own codes."""
    _check(arguments)
    goal = DROP if arguments.cancel else arguments.goal or ""
    with open_bus(arguments, "people") as session:
        follower = GoalFollower(session.inbox(["status"], "", newest_only=False), goal) if arguments.wait else None
        if follower is not None:
            follower.look()
        answers = session.call_all(KEY, goal)
        nobody = NOBODY if session.connected else LOST
        answers = [(accepted, nobody if answer == no_service(KEY) else answer) for accepted, answer in answers]
        if follower is not None and answers == [(True, ACCEPTED)]:
            return _followed(follower, arguments)
    if any(answer == NOBODY for _, answer in answers) and (advice := key_advice(arguments, "sends goals")):
        print(advice, file=sys.stderr)
    if not _print_answers(answers, arguments.json):
        return 2
    return 1 if arguments.wait and len(answers) > 1 else 0  # nobody was waited for


def _check(arguments: argparse.Namespace) -> None:
    if arguments.goal is not None and not arguments.goal.strip():
        raise UsageError("the goal is empty, expected a PDDL goal, or no argument for the goal of the scenario")
    if arguments.cancel and arguments.goal is not None:
        raise UsageError("--cancel: expected without a goal; another goal replaces the open one by itself")
    if arguments.cancel and arguments.wait:
        raise UsageError("--cancel: expected without --wait; it is over when the executive answers")
    if arguments.timeout is not None and not arguments.wait:
        raise UsageError("--timeout: expected with --wait, for which it is the longest time")


def _print_answers(answers: list[tuple[bool, str]], as_json: bool) -> bool:
    """Print what the executives answered; returns whether all accepted."""
    everyone = all(accepted for accepted, _ in answers)
    if as_json:
        print(json.dumps({"accepted": everyone, "answer": "; ".join(answer for _, answer in answers)}))
    else:
        for accepted, answer in answers:
            print(plain(answer), file=sys.stdout if accepted else sys.stderr)
    if len(answers) > 1:
        took = sum(accepted for accepted, _ in answers)
        split = f"{took} accepted it and {len(answers) - took} did not; " if 0 < took < len(answers) else ""
        print(f"{len(answers)} executives answered, expected one: {split}`tailor status` names them", file=sys.stderr)
    return everyone


def _followed(follower: GoalFollower, arguments: argparse.Namespace) -> int:
    """Follow an accepted goal to its end: 0 if it was achieved, else 1."""
    timeout_s = math.inf if arguments.timeout is None else arguments.timeout
    with stoppable() as stop:
        problem = follower.follow(timeout_s, (lambda _: None) if arguments.json else note, stop)
    result = follower.wait.result
    if result is None and stop.requested:
        note(PURSUED, to_stderr=True)
        return stop.exit_code
    if arguments.json:
        ended = {"result": "", "reason": "", "detail": "", "duration_s": None} if result is None else asdict(result)
        print(json.dumps({"accepted": True, "answer": ACCEPTED, **ended, "problem": problem}))
    elif result is None:
        print(problem, file=sys.stderr)
    else:
        print(plain(f"{result_text(result.result, result.reason, result.detail)} after {result.duration_s:.1f} s"))
    return 0 if result is not None and result.result == "achieved" else 1
