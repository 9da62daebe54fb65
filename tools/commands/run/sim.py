"""Run a simulated robot on the bus: its physics and sensors in real time, behind the driver's guard."""

from __future__ import annotations

import argparse
import importlib
import secrets
from collections.abc import Callable
from typing import Any

from tailor.runtime import realtime
from tailor.runtime.bus.session import open_client
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.simnodes.driver_spec import DriverSpec, declaration
from tailor.simnodes.node import Node
from tailor.simnodes.world import Event, World
from tailor.tools.cli.deployment import deployment
from tailor.tools.cli.endpoint import configure_bus

# robot -> (module and class of its body, the domain whose scenarios it plays)
ROBOTS = {
    "agilo": ("tailor.simnodes.agilo.body", "AgiloBody", "soccer"),
    "powercube": ("tailor.simnodes.powercube.body", "PowerCubeBody", "arm"),
}
MAX_SPEED = 10.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor sim`."""
    parser.add_argument("robot", help=f"which robot: {', '.join(ROBOTS)}")
    parser.add_argument("--scenario", help="where the world starts (default: the domain's first scenario)")
    parser.add_argument("--seed", type=int, help="of the start and of all noise (default 0)")
    parser.add_argument("--speed", type=float, default=1.0, metavar="X", help="world seconds per second (default 1)")
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """Simulate until told to stop."""
    if arguments.robot not in ROBOTS:
        raise UsageError(f"robot {arguments.robot!r} is not known, expected one of: {', '.join(ROBOTS)}")
    if not 0.1 <= arguments.speed <= MAX_SPEED:
        raise UsageError(f"--speed is {arguments.speed}, expected 0.1 to {MAX_SPEED:g}")
    read = deployment(arguments)
    world = make_world(arguments.robot, read.scenario, read.executive.seed)
    stop = stop_on_signals()
    with open_client(read.bus.endpoint) as session:
        codec.prime()
        realtime.take_fifo(realtime.DRIVER_PRIORITY)
        realtime.elevate_bus_threads()
        run_node(world, declaration(arguments.robot), session, lambda: stop.requested, arguments.speed)
    return 0


def run_node(world: World, declared: DriverSpec, session: Any, stopped: Callable[[], bool], speed: float = 1.0) -> None:
    """Put a world on the bus, under a fresh epoch."""
    epoch = 1 + secrets.randbelow(2**62)
    Node(world, declared, session, MonotonicClock(), epoch, speed).run(stopped)


def make_world(robot: str, scenario: str, seed: int) -> World:
    """The world of a scenario, drawn as the executive draws it; no scenario named: the domain's first.

    Raises:
      UsageError: The scenario is not known.
    """
    from tailor.executive import domains

    module, kind, domain = ROBOTS[robot]
    name = scenario or domains.scenarios(domain)[0]
    drawn, start = domains.seeded_scenario(domain, name, seed)
    body = getattr(importlib.import_module(module), kind)()
    return World(body, start, seed, [_event(row) for row in drawn.settings.get("events", ())])


def _event(row: dict[str, float]) -> Event:
    return Event(row["at_s"], {name: value for name, value in row.items() if name != "at_s"})
