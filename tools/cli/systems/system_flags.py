"""Flags of the commands that run an executive; a flag overrides the deployment file."""

from __future__ import annotations

import argparse
from dataclasses import replace

from tailor.tools.cli.number_checks import checked
from tailor.tools.cli.systems.deployment import Deployment, read_deployment
from tailor.tools.cli.systems.endpoint import configure_bus, with_bus_flags


def configure_system(parser: argparse.ArgumentParser) -> None:
    """Flags of `tailor up` and `tailor executive`."""
    parser.add_argument("domain", help="domain to run, e.g. soccer")
    parser.add_argument("--scenario", help="scenario of the domain (default: its first)")
    parser.add_argument("--seed", type=int, help="random seed (default 0)")
    parser.add_argument("--horizon", type=int, help="number of actions refined together; 1 is greedy (default 2)")
    parser.add_argument(
        "--planner",
        metavar="COMMAND",
        help="plan with an external program, e.g. 'vhpop -v1 -f MW-Loc', or with kairos or up:ENGINE (of "
        "unified-planning), in its own process with time and memory limits",
    )
    parser.add_argument("--zoo", help="folder of action models (default: that of the robot)")
    configure_bus(parser)


def deployment_from(arguments: argparse.Namespace) -> Deployment:
    """Deployment file named by --config, overridden by the other flags.

    Raises:
      UsageError: The file cannot be read (see `read_deployment`), or a number is out of its range.
    """
    deployment = read_deployment(arguments.config)
    deployment = replace(deployment, bus=with_bus_flags(deployment.bus, arguments))
    given = vars(arguments)
    settings = deployment.executive
    if given.get("seed") is not None:
        settings = replace(settings, seed=checked(given["seed"], 0, "--seed"))
    if given.get("horizon") is not None:
        horizon = checked(given["horizon"], 1, "--horizon")
        settings = replace(settings, refinement=replace(settings.refinement, horizon=horizon))
    if given.get("planner") is not None:
        deployment = replace(deployment, planner=replace(deployment.planner, command=given["planner"]))
    return replace(
        deployment,
        executive=settings,
        scenario=given.get("scenario") or deployment.scenario,
        zoo=given.get("zoo") or deployment.zoo,
    )
