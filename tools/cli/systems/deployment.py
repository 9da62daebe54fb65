"""Deployment files: one TOML file per deployment, read into frozen settings."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from tailor.executive.composition import ExecutiveConfig
from tailor.executive.deliberation.context import PlannerCommand, Settings
from tailor.runtime.planners.named import DURATIVE_HEAD_START, KAIROS, check_engine, kairos_installed
from tailor.runtime.processes.planner_process import split_command
from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import read_toml
from tailor.schemas.settings import from_table
from tailor.tools.cli.systems.bus_settings import BusSettings


@dataclass(frozen=True, slots=True)
class Deployment:
    """Content of a deployment file; its tables and keys are the fields."""

    bus: BusSettings = field(default_factory=BusSettings)
    executive: Settings = field(default_factory=Settings)
    planner: PlannerCommand = field(default_factory=PlannerCommand)
    scenario: str = ""  # of the domain; default: its first
    zoo: str = ""  # folder of action models; default: those of the robot's package


def read_deployment(path: str) -> Deployment:
    """Deployment file at `path`; defaults for an empty path.

    Raises:
      UsageError: The file is missing, is not TOML, or has an unknown key; all unknown keys in one line.
    """
    if not path:
        return Deployment()
    if Path(path).is_fifo():  # a command and its children read it several times; empty, it names the default bus
        raise UsageError(f"{path}: a pipe, expected a deployment file that can be read again")
    deployment = from_table(Deployment, read_toml(path, "a deployment file"), path)
    if deployment.executive.external != PlannerCommand():  # there for recordings, which hold the executive's settings
        raise UsageError(f"{path}: table executive.external, expected its keys in the table planner")
    return deployment


def executive_config(domain: str, deployment: Deployment) -> ExecutiveConfig:
    """Configuration of an executive; composition checks the scenario's name.

    Raises:
      UsageError: The configured external planner does not exist, or is none.
    """
    from tailor.executive import domains

    scenario = deployment.scenario or domains.scenarios(domain)[0]
    settings, planner = deployment.executive, deployment.planner
    if planner.engine == "auto":  # the file may name one beside the search's other settings instead
        planner = replace(planner, engine=settings.planner.engine)
    if planner.costs != "steps":
        settings = replace(settings, plan_costs=planner.costs)
    if planner.engine != "kairos":
        settings = replace(settings, planner=replace(settings.planner, engine=planner.engine))
    planner = _external(planner, domain)
    if planner.command:
        split_command(planner.command)
        check_engine(planner.command)
        settings = replace(settings, external=planner)
    return ExecutiveConfig(domain, scenario, settings, deployment.zoo)


def _external(planner: PlannerCommand, domain: str) -> PlannerCommand:
    """The external planner of an engine's name; with "auto" kairos-planner for durations, if it is installed."""
    from tailor.executive import domains

    if planner.engine == "kairos":
        return replace(planner, command=KAIROS)
    durative = ":durative-action" in domains.load(domain).pddl.lower()
    if planner.engine == "auto" and not planner.command and durative and kairos_installed():
        return replace(planner, command=KAIROS, after_plans=max(planner.after_plans, DURATIVE_HEAD_START))
    return planner
