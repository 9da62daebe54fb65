"""Run the executive on the bus: connect, wait until people arm the driver, pursue the scenario's goal at 10 Hz."""

from __future__ import annotations

import argparse
import time
from dataclasses import replace
from functools import partial

from tailor.executive.composition import build_context, provenance
from tailor.executive.core.state import State
from tailor.executive.deliberation.context import Context, check_goal, drops_goal
from tailor.executive.interfaces.reasons import Reason
from tailor.executive.robot_models import check_models
from tailor.executive.shell import Shell
from tailor.runtime import numpy_blocks, realtime
from tailor.runtime.clock import MonotonicClock, wall_ns
from tailor.runtime.malloc_settings import set_for_loop
from tailor.runtime.platform_fingerprint import platform_fingerprint
from tailor.runtime.processes.notify import Notifier
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of
from tailor.schemas.installed.core_source import core_source
from tailor.schemas.ros_time import wrapped_ns
from tailor.tools.cli.package_run import blamed_on_running_package
from tailor.tools.cli.plain_text import note
from tailor.tools.cli.systems.bus_end import BusEnd
from tailor.tools.cli.systems.deployment import executive_config
from tailor.tools.cli.systems.endpoint import checked_sender, configure_sender, open_bus, sender_of
from tailor.tools.cli.systems.system_flags import configure_system, deployment_from
from tailor.tools.launch.arming_advice import arming_advice
from tailor.tools.launch.checks.driver_check import check_driver, driver_of, sensor_rates_hz
from tailor.tools.launch.checks.package_check import check_package
from tailor.tools.launch.once import outcome
from tailor.tools.launch.others import other_executives_noted
from tailor.tools.launch.state_lines import seldom, state_lines
from tailor.tools.recordings.recorded_source import source_entry


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor executive`."""
    configure_system(parser)
    parser.add_argument(
        "--driver", metavar="FILE", help="specification of the driver (default: that of the simulated robot)"
    )
    parser.add_argument("--goal", help="PDDL goal to start with (default: the scenario's)")
    parser.add_argument("--wait", action="store_true", help="start without a goal; `tailor goal` sends one")
    configure_sender(parser)
    parser.add_argument("--driver-sender", metavar="HEX", help="sender id of the driver (default: the first heard)")
    parser.add_argument("--once", action="store_true", help="end when the goal is achieved (0) or has failed (1)")


def run(arguments: argparse.Namespace) -> int:
    """Compose and check the configuration, then tick until stopped, or until another run of the bus has begun."""
    stop, notifier = stop_on_signals(), Notifier.from_environment()
    end = BusEnd(arguments, stop)
    set_for_loop()
    deployment = deployment_from(arguments)
    check_package(arguments.domain)
    config = executive_config(arguments.domain, deployment)
    context = build_context(config, sender="")  # configuration errors are reported before the bus is opened
    check_models(context)
    driver = driver_of(context.domain, arguments.driver)
    check_driver(context.domain, driver)
    context = replace(context, sensor_rates_hz=sensor_rates_hz(context.domain, driver))
    goal = _goal(context, arguments)
    driver_sender = checked_sender(arguments.driver_sender, "--driver-sender")
    with open_bus(arguments, "executive", sender=sender_of(arguments)) as session:
        offset_ns = wrapped_ns(wall_ns()) - time.monotonic_ns()
        context = replace(context, sender=session.sender, stamp_offset_ns=offset_ns, driver_sender=driver_sender)
        codec.prime()
        numpy_blocks.fill()
        origin = {**provenance(config, context), "machine": platform_fingerprint()}
        origin["source"] = source_entry(core_source(context.domain.name))
        origin["realtime"] = realtime.prepare()
        shell = Shell(context, session, MonotonicClock(), origin, notifier)
        print_states = not notifier.supervised
        if print_states:
            print(beginning(context, goal), flush=True)
        texts = [seldom(lambda: shell.refused_fields)]  # also beneath a launcher: the status does not tell it
        if print_states:
            texts.append(lambda: state_line(shell.state, context.domain.robot))
        noted = other_executives_noted(session, partial(note, to_stderr=True))
        with noted, blamed_on_running_package(spec_of(arguments.domain)), state_lines(*texts):
            state = shell.run(goal, lambda state: end.reached(session) or (arguments.once and _is_over(state)))
    end.check()
    if arguments.once and stop.requested and not _is_over(state):
        return stop.exit_code
    return 1 if arguments.once and state.task.result != "achieved" else 0


def _is_over(state: State) -> bool:
    return bool(outcome(state.mode, state.task.result_text, str(state.cause)))


def beginning(context: Context, goal: str) -> str:
    """What the executive is about to do."""
    pursued = f"goal {goal}" if goal else "no goal yet; `tailor goal` sends one"
    return f"executive of {context.domain.robot}: {pursued}; Ctrl-C stops"


def state_line(state: State, robot: str) -> str:
    """What the executive waits for or does, in one line."""
    if state.task.result:
        return f"{state.task.result_text}; `tailor goal` sends another goal"
    running = state.task.running
    doing = f": {running.action.name}" if running is not None else ""
    return f"{state.mode}{doing}" + (f": {state.cause}" if state.cause is not None else "") + _advice(state, robot)


def _advice(state: State, robot: str) -> str:
    """How people go on where the executive can only wait."""
    reason = state.cause.reason if state.cause is not None else None
    if reason is Reason.DRIVER_NOT_ARMED:
        driver = state.arming.driver
        known = (driver.mode, driver.reason, driver.detail) if driver is not None else ("",)
        advice = arming_advice(robot, *known)
        return f"; {advice}" if advice else ""
    if reason is Reason.REPEATED_FAILURE:
        return "; remove the cause, then `tailor goal` sends a goal"
    return f"; `tailor sim {robot}` or a driver of {robot} is expected" if reason is Reason.DRIVER_SILENT else ""


def _goal(context: Context, arguments: argparse.Namespace) -> str:
    if arguments.wait and arguments.goal is not None:
        raise UsageError("--goal: expected without --wait, which starts without a goal")
    if arguments.goal is not None and not arguments.goal.strip():
        raise UsageError("--goal is empty, expected a PDDL goal, or no --goal for the goal of the scenario")
    if arguments.wait:
        return ""
    goal: str = arguments.goal or context.problem.goal_text
    refusal = check_goal(context, goal)
    if refusal is not None:
        raise UsageError(f"--goal {goal}: {refusal}")
    if drops_goal(context, goal):
        raise UsageError(f"--goal {goal}: has no condition, expected one, or --wait to start without a goal")
    return goal
