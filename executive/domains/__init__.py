"""The robots and tasks that ship, by name. A new robot is a new folder here."""

from __future__ import annotations

import importlib
import tomllib
from collections.abc import Mapping
from importlib import resources
from typing import Any

import numpy as np

from tailor.executive.interfaces.domain import Domain, Scenario
from tailor.schemas.errors import UsageError

SCENARIO_STREAM = 0  # of a run's seed; noise and search are drawn from others
DOMAINS = ("soccer", "arm")


def load(name: str) -> Domain:
    """The domain of that name; raises UsageError listing those that there are."""
    if name not in DOMAINS:
        raise UsageError(f"no domain {name!r}, expected one of: {', '.join(DOMAINS)}")
    made: Domain = _package(name).make()
    return made


def scenarios(name: str) -> list[str]:
    """Names of a domain's scenarios, the default first."""
    load(name)
    if _invents(name):
        invented: list[str] = _package(name).scenarios()
        return invented
    declared = ((_declaration(name, file), file) for file in _scenario_files(name))
    return [file for _, file in sorted(declared, key=lambda pair: (pair[0].get("order", 99), pair[1]))]


def load_scenario(name: str, scenario: str, rng: np.random.Generator) -> tuple[Scenario, dict[str, float]]:
    """A scenario with its places drawn from `rng`, and the start state of robot and world.

    The settings of the scenario carry its events: what happens to the world by itself, as {"at_s": seconds since the
    first command, and values for Body.place}.

    Raises:
      UsageError: Unknown domain or scenario.
    """
    known = scenarios(name)
    if _invents(name):
        invented: tuple[Scenario, dict[str, float]] = _package(name).load_scenario(scenario, rng)
        return invented
    if scenario not in known:
        raise UsageError(f"no scenario {scenario!r} in {name}, expected one of: {', '.join(known)}")
    declared = _declaration(name, scenario)
    problem = resources.files(f"tailor.executive.domains.{name}.scenarios").joinpath(declared["problem"]).read_text()
    start, places, events = _package(name).sample_scenario(declared, rng)
    settings = {**declared.get("settings", {}), "events": events}
    return Scenario(scenario, problem, places, settings), start


def seeded_scenario(name: str, scenario: str, seed: int) -> tuple[Scenario, dict[str, float]]:
    """`load_scenario` as a run's seed draws it: executive and simulator get the same world from the same seed."""
    return load_scenario(name, scenario, np.random.default_rng([seed, SCENARIO_STREAM]))


def _package(name: str) -> Any:
    """A domain's package; it offers `make()` and `draw(declared, rng) -> (start, places, events)`.

    One that makes its scenarios up offers `scenarios()` and `load_scenario(scenario, rng)` instead of `draw` and files.
    """
    return importlib.import_module(f"tailor.executive.domains.{name}")


def _invents(name: str) -> bool:
    """Whether a domain makes its scenarios up, as the arm does from the letters of a font."""
    return hasattr(_package(name), "load_scenario")


def _scenario_files(name: str) -> list[str]:
    folder = resources.files(f"tailor.executive.domains.{name}.scenarios")
    return [file.name.removesuffix(".toml") for file in folder.iterdir() if file.name.endswith(".toml")]


def _declaration(name: str, scenario: str) -> Mapping[str, Any]:
    folder = resources.files(f"tailor.executive.domains.{name}.scenarios")
    return tomllib.loads(folder.joinpath(f"{scenario}.toml").read_text())
