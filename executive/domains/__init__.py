"""The shipped domains by name. A new robot is a new folder here."""

from __future__ import annotations

import importlib
import tomllib
from collections.abc import Mapping
from importlib import resources
from typing import Any

import numpy as np

from tailor.executive.interfaces.domain import Domain, Scenario
from tailor.schemas.errors import UsageError

SCENARIO_STREAM = 0  # random stream of a run's seed; noise and search use others
DOMAINS = ("soccer", "arm")


def load(name: str) -> Domain:
    """Load a domain.

    Raises:
      UsageError: Unknown name; the message lists the known ones.
    """
    if name not in DOMAINS:
        raise UsageError(f"no domain {name!r}, expected one of: {', '.join(DOMAINS)}")
    made: Domain = _package(name).make()
    return made


def scenarios(name: str) -> list[str]:
    """Names of a domain's scenarios, the default first."""
    load(name)
    if _generates_scenarios(name):
        generated: list[str] = _package(name).scenarios()
        return generated
    declared = ((_declaration(name, file), file) for file in _scenario_files(name))
    return [file for _, file in sorted(declared, key=lambda pair: (pair[0].get("order", 99), pair[1]))]


def load_scenario(name: str, scenario: str, rng: np.random.Generator) -> tuple[Scenario, dict[str, float]]:
    """Load a scenario with its places drawn from `rng`, and the start state of robot and world.

    The settings of the scenario contain its events, changes of the world, as {"at_s": seconds since the first command,
    and values for Body.place}.

    Raises:
      UsageError: Unknown domain or scenario.
    """
    known = scenarios(name)
    if _generates_scenarios(name):
        generated: tuple[Scenario, dict[str, float]] = _package(name).load_scenario(scenario, rng)
        return generated
    if scenario not in known:
        raise UsageError(f"no scenario {scenario!r} in {name}, expected one of: {', '.join(known)}")
    declared = _declaration(name, scenario)
    problem = resources.files(f"tailor.executive.domains.{name}.scenarios").joinpath(declared["problem"]).read_text()
    start, places, events = _package(name).sample_scenario(declared, rng)
    settings = {**declared.get("settings", {}), "events": events}
    return Scenario(scenario, problem, places, settings), start


def seeded_scenario(name: str, scenario: str, seed: int) -> tuple[Scenario, dict[str, float]]:
    """`load_scenario` with the generator of a run's seed: executive and simulator draw the same world."""
    return load_scenario(name, scenario, np.random.default_rng([seed, SCENARIO_STREAM]))


def _package(name: str) -> Any:
    """A domain's package; it offers `make()` and `sample_scenario(declared, rng) -> (start, places, events)`.

    One that generates its scenarios offers `scenarios()` and `load_scenario(scenario, rng)` instead of the latter and
    of files.
    """
    return importlib.import_module(f"tailor.executive.domains.{name}")


def _generates_scenarios(name: str) -> bool:
    """Whether a domain generates its scenarios, as the arm does from the letters of a font."""
    return hasattr(_package(name), "load_scenario")


def _scenario_files(name: str) -> list[str]:
    folder = resources.files(f"tailor.executive.domains.{name}.scenarios")
    return [file.name.removesuffix(".toml") for file in folder.iterdir() if file.name.endswith(".toml")]


def _declaration(name: str, scenario: str) -> Mapping[str, Any]:
    folder = resources.files(f"tailor.executive.domains.{name}.scenarios")
    return tomllib.loads(folder.joinpath(f"{scenario}.toml").read_text())
