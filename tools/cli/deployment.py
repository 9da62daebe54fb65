"""Deployment files: one TOML file per deployment, read into frozen settings."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path

from tailor.executive.composition import ExecutiveConfig
from tailor.executive.core.context import PlannerCommand, Settings
from tailor.runtime.processes.planner_process import split_command
from tailor.schemas.errors import UsageError
from tailor.schemas.settings import from_table
from tailor.tools.cli.bus_settings import BusSettings


@dataclass(frozen=True, slots=True)
class Deployment:
    """Content of a deployment file; its tables and keys are the fields."""

    bus: BusSettings = field(default_factory=BusSettings)
    executive: Settings = field(default_factory=Settings)
    planner: PlannerCommand = field(default_factory=PlannerCommand)
    scenario: str = ""
    zoo: str = ""


def read_deployment(path: str) -> Deployment:
    """Deployment file at `path`; defaults for an empty path.

    Raises:
      UsageError: The file is missing, is not TOML, or has an unknown key; all unknown keys in one line.
    """
    if not path:
        return Deployment()
    try:
        table = tomllib.loads(Path(path).read_text())
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}, expected a deployment file") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: not TOML: {error}") from error
    return from_table(Deployment, table, path)


def executive_config(domain: str, deployment: Deployment) -> ExecutiveConfig:
    """Configuration of an executive; composition checks the scenario's name.

    Raises:
      UsageError: The configured external planner does not exist.
    """
    from tailor.executive import domains

    scenario = deployment.scenario or domains.scenarios(domain)[0]
    settings = deployment.executive
    settings = replace(settings, planner=replace(settings.planner, engine=deployment.planner.engine))
    if deployment.planner.command:
        split_command(deployment.planner.command)
        settings = replace(settings, external=deployment.planner)
    return ExecutiveConfig(domain, scenario, settings, deployment.zoo)
