"""One TOML file per deployment, into frozen settings; flags on the command line win over it."""

from __future__ import annotations

import argparse
import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path

from tailor.executive.composition import ExecutiveConfig
from tailor.executive.core.context import PlannerCommand, Settings
from tailor.runtime.bus.zenoh_config import DEFAULT_ENDPOINT
from tailor.runtime.processes.planner_process import words_of
from tailor.schemas.errors import UsageError
from tailor.schemas.settings import from_table
from tailor.tools.cli.endpoint import configure_bus
from tailor.tools.cli.number_checks import checked


@dataclass(frozen=True, slots=True)
class Bus:
    """Where the router listens and everyone else connects."""

    endpoint: str = DEFAULT_ENDPOINT


@dataclass(frozen=True, slots=True)
class Deployment:
    """Everything that a deployment file may say."""

    bus: Bus = field(default_factory=Bus)
    executive: Settings = field(default_factory=Settings)
    planner: PlannerCommand = field(default_factory=PlannerCommand)
    scenario: str = ""
    zoo: str = ""


def configure_system(parser: argparse.ArgumentParser) -> None:
    """The flags that `up`, `demo` and `executive` share."""
    parser.add_argument("domain", help="what to run: a folder of executive/domains, e.g. soccer")
    parser.add_argument("--scenario", help="one of the domain's scenarios (default: its first)")
    parser.add_argument("--seed", type=int, help="of every random draw (default 0)")
    parser.add_argument("--horizon", type=int, help="actions that refinement looks ahead; 1 is greedy (default 2)")
    parser.add_argument("--planner", metavar="COMMAND", help="a real vhpop is asked first, e.g. 'vhpop -v1 -f MW-Loc'")
    parser.add_argument("--zoo", help="folder of action models (default: those that ship)")
    configure_bus(parser)


def deployment(arguments: argparse.Namespace) -> Deployment:
    """The deployment file with the flags put over it.

    Raises:
      UsageError: The file is missing, is not TOML, or says something unknown; all of it in one line.
    """
    read = _read(arguments.config) if arguments.config else Deployment()
    if arguments.connect:
        read = replace(read, bus=replace(read.bus, endpoint=arguments.connect))
    given = vars(arguments)
    settings = read.executive
    if given.get("seed") is not None:
        settings = replace(settings, seed=checked(given["seed"], 0, "--seed"))
    if given.get("horizon") is not None:
        horizon = checked(given["horizon"], 1, "--horizon")
        settings = replace(settings, refinement=replace(settings.refinement, horizon=horizon))
    if given.get("planner") is not None:
        read = replace(read, planner=replace(read.planner, command=given["planner"]))
    return replace(
        read,
        executive=settings,
        scenario=given.get("scenario") or read.scenario,
        zoo=given.get("zoo") or read.zoo,
    )


def order_of(domain: str, read: Deployment) -> ExecutiveConfig:
    """What the executive is to run; the scenario's name is checked when it is composed.

    Raises:
      UsageError: There is no such external planner.
    """
    from tailor.executive import domains

    scenario = read.scenario or domains.scenarios(domain)[0]
    settings = read.executive
    if read.planner.command:
        words_of(read.planner.command)
        settings = replace(settings, external=read.planner)
    return ExecutiveConfig(domain, scenario, settings, read.zoo)


def _read(path: str) -> Deployment:
    try:
        table = tomllib.loads(Path(path).read_text())
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected a deployment file") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: not TOML: {error}") from error
    return from_table(Deployment, table, path)
