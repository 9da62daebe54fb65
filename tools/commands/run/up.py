"""Start a whole system and watch it: bus router, simulator, recorder, scene, executive. Ctrl-C stops it in order.

With --hardware a real robot takes the simulator's place. Then people arm it, after every start: `tailor arm ROBOT`.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from tailor.executive import domains
from tailor.runtime.malloc_settings import set_for_host
from tailor.runtime.stopping import stop_on_signals
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of
from tailor.tools.cli.live_status import screen
from tailor.tools.cli.systems.bus_settings import configure_hosting, with_hosting_flags
from tailor.tools.cli.systems.deployment import executive_config
from tailor.tools.cli.systems.system_flags import configure_system, deployment_from
from tailor.tools.launch.checks.package_check import check_package
from tailor.tools.launch.hardware import check_sensors, hardware_of
from tailor.tools.launch.processes import LaunchConfig
from tailor.tools.launch.stale_models import stale_models_warning
from tailor.tools.launch.system import run_system

EPILOG = """\
examples:
  tailor up soccer --record run.mcap                 (Ctrl-C stops it; then tailor view run.mcap)
  tailor up soccer --scenario waypoints --seed 3 --once
  tailor up courier --hardware robot.toml            (a real robot; then tailor arm courier)
  tailor up soccer --secure                          (other machines, after tailor keys new router --host ADDRESS)

In another terminal: tailor status, tailor estop, tailor goal. A robot that was stopped is armed by tailor arm ROBOT."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor up`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    configure_system(parser)
    configure_hosting(parser)
    parser.add_argument(
        "--hardware",
        metavar="FILE.toml|MODULE:CLASS",
        default="",
        help="a real robot instead of the simulator, as for `tailor driver`; a person arms it",
    )
    parser.add_argument("--record", metavar="FILE", type=Path, help="record all messages into an MCAP file")
    parser.add_argument(
        "--require-recording", action="store_true", help="end (1) when the recording ends or lacks a message"
    )
    parser.add_argument(
        "--no-scene", action="store_true", help="publish no markers and transforms (tf) for viewers in 3D"
    )
    parser.add_argument("--letters", metavar="TEXT", help="text that the arm writes; short for --scenario word-TEXT")
    parser.add_argument("--once", action="store_true", help="end when the goal is achieved (0) or has failed (1)")


def run(arguments: argparse.Namespace) -> int:
    """Run until Ctrl-C (0), or with --once until the goal is achieved (0) or has failed (1).

    A system that ends by itself is a failure as well (1). With --once, a signal before that has its own exit code.
    """
    stop = stop_on_signals()
    set_for_host()
    if arguments.require_recording and arguments.record is None:
        raise UsageError("--require-recording: expected --record FILE as well")
    if arguments.letters is not None:
        if arguments.scenario is not None:
            raise UsageError("--letters: expected without --scenario, whose letters are its own")
        arguments.scenario = f"word-{arguments.letters.upper()}"
    deployment = deployment_from(arguments)
    check_package(arguments.domain)
    stale = stale_models_warning(arguments.domain, deployment.zoo)
    if stale:
        print(f"warning: {stale}", file=sys.stderr)
    config = LaunchConfig(
        executive_config(arguments.domain, deployment),
        with_hosting_flags(deployment.bus, arguments),
        record=arguments.record,
        once=arguments.once,
        deployment_file=arguments.config,
        planner=deployment.planner.command,
        require_recording=arguments.require_recording,
        scene=not arguments.no_scene,
        hardware=arguments.hardware,
    )
    if config.hardware:
        _check_hardware(config)
    with screen() as shown:
        result = run_system(config, shown, stop)
    print(result or "stopped")
    if arguments.once and not result:
        return stop.exit_code
    done = result == "achieved" if arguments.once else stop.requested
    return 0 if done else 1


def _check_hardware(config: LaunchConfig) -> None:
    """Raise UsageError if there is no such hardware, it is another robot's, or it lacks a required sensor."""
    robot = hardware_of(config.hardware, config.bus.endpoint).robot
    expected = spec_of(config.executive.domain).robot
    if robot != expected:
        raise UsageError(f"--hardware {config.hardware}: is of the robot '{robot}', expected '{expected}'")
    check_sensors(config.hardware, domains.load(config.executive.domain).required)
