"""Run a simulated robot on the bus: physics and sensors in real time, behind the driver's guard."""

from __future__ import annotations

import argparse
import secrets
from collections.abc import Callable
from functools import partial

from tailor.runtime import realtime
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.processes.notify import Notifier
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import robot_names, spec_of_robot
from tailor.schemas.reason_text import reason_text
from tailor.simnodes.driver_spec import driver_spec_to_run
from tailor.simnodes.guard import Guard, Mode
from tailor.simnodes.node import Node
from tailor.simnodes.world import World
from tailor.tools.cli.package_run import blamed_on_running_package
from tailor.tools.cli.plain_text import note
from tailor.tools.cli.systems.bus_end import BusEnd
from tailor.tools.cli.systems.endpoint import checked_sender, configure_bus, configure_sender, open_bus, sender_of
from tailor.tools.cli.systems.system_flags import deployment_from
from tailor.tools.launch.arming_advice import arming_advice
from tailor.tools.launch.others import other_drivers_noted
from tailor.tools.launch.state_lines import state_lines
from tailor.tools.lockstep.worlds import make_world

MAX_SPEED = 10.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor sim`."""
    parser.add_argument("robot", help=f"robot to simulate: {', '.join(robot_names())}")
    parser.add_argument("--scenario", help="scenario to start in (default: the first of the domain)")
    parser.add_argument("--seed", type=int, help="random seed (default 0)")
    parser.add_argument(
        "--speed", type=float, default=1.0, metavar="X", help="simulated seconds per second (default 1)"
    )
    parser.add_argument("--leave", metavar="HEX", default="", help="sender id of the executive that may arm it once")
    configure_sender(parser)
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Simulate until stopped, or until the run of the bus has ended and another one has begun."""
    notifier = Notifier.from_environment()
    declared = driver_spec_to_run(arguments.robot)
    if not 0.1 <= arguments.speed <= MAX_SPEED:
        raise UsageError(f"--speed is {arguments.speed}, expected 0.1 to {MAX_SPEED:g}")
    leave = checked_sender(arguments.leave, "--leave")
    deployment = deployment_from(arguments)
    world = _world(arguments.robot, deployment.scenario, deployment.executive.seed)
    end = BusEnd(arguments, stop_on_signals())
    with open_bus(arguments, "driver", sender=sender_of(arguments)) as session:
        codec.prime()
        realtime.take_fifo(realtime.DRIVER_PRIORITY)
        realtime.elevate_bus_threads()
        epoch = 1 + secrets.randbelow(2**62)  # another one at every start
        node = Node(world, declared, session, MonotonicClock(), epoch, arguments.speed, leave)
        noted = other_drivers_noted(session, arguments.robot, partial(note, to_stderr=True))
        with noted, blamed_on_running_package(spec_of_robot(arguments.robot)):
            _run(node, world.body.robot, lambda: end.reached(session), notifier)
    end.check()
    return 0


def _world(robot: str, scenario: str, seed: int) -> World:
    """`make_world`, of the robot that its package declares."""
    spec, world = spec_of_robot(robot), make_world(robot, scenario, seed)
    if world.body.robot != robot:
        raise UsageError(f"{spec.body}: robot is '{world.body.robot}', expected '{robot}' by the spec")
    return world


def _run(node: Node, robot: str, ended: Callable[[], bool], notifier: Notifier) -> None:
    print_states = not notifier.supervised
    if print_states:
        print(f"simulated {robot} on the bus; Ctrl-C stops", flush=True)
    texts = [lambda: state_line(node.driver.guard, robot)] if print_states else []  # else the supervisor reports it
    with state_lines(*texts):
        node.run(ended, notifier)


def state_line(guard: Guard, robot: str) -> str:
    """What the driver obeys or waits for, in one line."""
    if guard.mode is Mode.ARMED:
        return f"armed: obeys {guard.sender[:8]}"
    cause = reason_text(guard.reason, guard.detail)
    advice = arming_advice(robot, guard.mode, guard.reason)
    return f"{guard.mode}: {cause}" + (f"; {advice} for an executive" if advice else "")
