"""Run the executive on the bus: it connects, arms the robot's driver, and pursues the scenario's goal at 10 Hz."""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

from tailor.executive.composition import build_context, provenance
from tailor.executive.core.context import Context, check_goal
from tailor.executive.shell import Shell
from tailor.runtime import realtime
from tailor.runtime.bus.session import open_client
from tailor.runtime.clock import MonotonicClock, wall_ns
from tailor.runtime.platform_fingerprint import platform_fingerprint
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.tools.cli.deployment import configure_system, deployment, order_of
from tailor.tools.launch.driver_check import check_driver, driver_of


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor executive`."""
    configure_system(parser)
    parser.add_argument("--driver", metavar="FILE", help="the driver's declaration (default: the simulated robot's)")
    parser.add_argument("--goal", help="PDDL goal to start with (default: the scenario's)")
    parser.add_argument("--wait", action="store_true", help="start without a goal and wait for `tailor goal`")
    parser.add_argument("--once", action="store_true", help="end when the goal is achieved (0) or has failed (1)")


def run(arguments: argparse.Namespace) -> int:
    """Compose, check everything, then tick until stopped."""
    stop = stop_on_signals()
    read = deployment(arguments)
    order = order_of(arguments.domain, read)
    context = build_context(order, sender="")  # every mistake of ours is told before the bus is touched
    check_driver(context.domain, driver_of(context.domain.robot, arguments.driver))
    goal = _goal(context, arguments)
    with open_client(read.bus.endpoint) as session:
        offset_ns = wall_ns() - time.monotonic_ns()
        context = replace(context, sender=session.sender, stamp_offset_ns=offset_ns)
        codec.prime()
        made_of = {**provenance(order, context), "machine": platform_fingerprint()}
        made_of["realtime"] = realtime.prepare()
        shell = Shell(context, session, MonotonicClock(), made_of)
        state = shell.run(goal, lambda state: stop.requested or (arguments.once and bool(state.task.result)))
    return 1 if arguments.once and state.task.result != "achieved" else 0


def _goal(context: Context, arguments: argparse.Namespace) -> str:
    if arguments.wait:
        return ""
    goal: str = arguments.goal or context.problem.goal_text
    why_not = check_goal(context, goal)
    if why_not:
        raise UsageError(f"--goal {goal}: {why_not}")
    return goal
