"""Drive a real robot: guard, arming, e-stop, watchdogs and state around its hardware, until stopped.

FILE.toml describes a robot with plain topics (cmd_vel, odom), without code; MODULE:CLASS names a subclass of
tailor.simnodes.hardware.interface.Hardware. See docs/hardware.md.
"""

from __future__ import annotations

import argparse
import secrets
from collections.abc import Callable
from functools import partial

from tailor.runtime import realtime
from tailor.runtime.aside import Aside, aside
from tailor.runtime.clock import MonotonicClock
from tailor.runtime.processes.notify import Notifier
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas import codec
from tailor.schemas.errors import UsageError
from tailor.simnodes.driver_spec import driver_spec_to_run
from tailor.simnodes.hardware.node import HardwareNode
from tailor.simnodes.hardware.watchdogs import RetryPolicy
from tailor.tools.cli.plain_text import note, plain
from tailor.tools.cli.systems.bus_end import BusEnd
from tailor.tools.cli.systems.endpoint import (
    bus_settings,
    checked_sender,
    configure_bus,
    configure_sender,
    open_bus,
    sender_of,
)
from tailor.tools.launch.hardware import hardware_of
from tailor.tools.launch.others import other_drivers_noted

EPILOG = """\
examples:
  tailor driver robot.toml
  tailor driver mypackage.rover:Rover
  tailor driver examples/rover_driver.py:Rover

robot.toml, at its shortest, for a robot whose package is courier:
  robot = "courier"
  [bus]
  connect = "tcp/192.168.0.7:7447"  # the robot's zenoh router, or zenoh-bridge-ros2dds

A bus must run: tailor bus. Then tailor check-driver ROBOT, tailor executive DOMAIN --wait, tailor arm ROBOT."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor driver`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("hardware", metavar="FILE.toml|MODULE:CLASS", help="description or class of the hardware")
    parser.add_argument("--leave", metavar="HEX", default="", help="sender id of the executive that may arm it once")
    parser.add_argument(
        "--attempts", type=int, default=0, metavar="N", help="end (1) after N faults in a row (default 0: never)"
    )
    configure_sender(parser)
    configure_bus(parser)


def run(arguments: argparse.Namespace) -> int:
    """0 when stopped; 1 when the hardware failed --attempts times. It also ends with the run of the bus."""
    notifier = Notifier.from_environment()
    if arguments.attempts < 0:
        raise UsageError(f"--attempts is {arguments.attempts}, expected at least 0")
    leave = checked_sender(arguments.leave, "--leave")
    hardware = hardware_of(arguments.hardware, bus_settings(arguments).endpoint)
    spec = driver_spec_to_run(hardware.robot)
    end = BusEnd(arguments, stop_on_signals())
    with aside() as terminal, open_bus(arguments, "driver", sender=sender_of(arguments)) as session:
        codec.prime()
        realtime.take_fifo(realtime.DRIVER_PRIORITY)
        realtime.elevate_bus_threads()
        report = reporter(hardware.robot, terminal)
        node = HardwareNode(
            hardware,
            spec,
            session,
            MonotonicClock(),
            epoch=1 + secrets.randbelow(2**62),
            leave=leave,
            retry=RetryPolicy(attempts=arguments.attempts),
            report=report,
        )
        with other_drivers_noted(session, hardware.robot, report):
            code = 0 if node.run(lambda: end.reached(session), notifier) else 1
    end.check()
    return code


def reporter(robot: str, terminal: Aside) -> Callable[[str], None]:
    """Prints lines about a robot, with text from its device, beside the guard's loop: it never waits for a terminal."""
    return lambda line: terminal.call(partial(note, plain(f"{robot}: {line}"), to_stderr=True))
