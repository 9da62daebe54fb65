"""Domains and their scenarios by name, as installed packages declare them."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources.abc import Traversable
from typing import Any

import numpy as np

from tailor.executive.interfaces.domain import Domain, Doubt, Scenario
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import file, instance, part, spec_of
from tailor.schemas.packages.spec import DomainSpec
from tailor.schemas.parsed_files import toml_table
from tailor.schemas.topics import TOPICS

LAST = 99.0  # order of a scenario that declares none
SCENARIO_STREAM = 0  # random stream of a run's seed; noise and search use others


def load(name: str) -> Domain:
    """Load a domain.

    Raises:
      UsageError: Unknown name; the message lists the known ones. Or the package cannot be used.
    """
    made: Domain = instance(spec_of(name), "domain")
    return made


def doubts(name: str) -> Mapping[str, Doubt]:
    """Which readings of a domain's robot contradict its belief, by topic: those are believed once they are repeated.

    Raises:
      UsageError: Unknown domain, or its spec names something else.
    """
    spec = spec_of(name)
    if not spec.doubts:
        return {}
    found: Any = part(spec, "doubts")
    if not isinstance(found, Mapping) or not all(topic in TOPICS and callable(found[topic]) for topic in found):
        raise UsageError(f"domain {name}: doubts = '{spec.doubts}': expected functions (before, after) by topic")
    return found


def scenarios(name: str) -> list[str]:
    """Names of a domain's scenarios, the default first.

    Raises:
      UsageError: Unknown domain.
    """
    spec = spec_of(name)
    if spec.generator:
        generated: list[str] = part(spec, "generator").scenarios()
        return generated
    return sorted(_scenario_files(spec), key=lambda scenario: (_order(_declaration(spec, scenario)), scenario))


def load_scenario(name: str, scenario: str, rng: np.random.Generator) -> tuple[Scenario, dict[str, float]]:
    """Load a scenario with its places drawn from `rng`, and the start state of robot and world.

    The settings of the scenario contain its events, changes of the world, as {"at_s": seconds since the first command,
    and values for Body.place}.

    Raises:
      UsageError: Unknown domain or scenario.
    """
    spec, known = spec_of(name), scenarios(name)
    if spec.generator:
        generated: tuple[Scenario, dict[str, float]] = part(spec, "generator").load_scenario(scenario, rng)
        return generated
    if scenario not in known:
        raise UsageError(f"no scenario {scenario!r} in {name}, expected one of: {', '.join(known)}")
    declared = _declaration(spec, scenario)
    problem = _folder(spec).joinpath(declared["problem"]).read_text(encoding="utf-8")
    start, places, events = part(spec, "draw")(declared, rng)
    settings = {**declared.get("settings", {}), "events": events}
    return Scenario(scenario, problem, places, settings), start


def seeded_scenario(name: str, scenario: str, seed: int) -> tuple[Scenario, dict[str, float]]:
    """`load_scenario` with the generator of a run's seed: executive and simulator draw the same world."""
    return load_scenario(name, scenario, np.random.default_rng([seed, SCENARIO_STREAM]))


def declaration(spec: DomainSpec, scenario: str) -> Mapping[str, Any]:
    """The table of a scenario file.

    Raises:
      ValueError: The file is no TOML in UTF-8.
    """
    try:
        return toml_table(_folder(spec).joinpath(f"{scenario}.toml").read_text(encoding="utf-8"))
    except UnicodeDecodeError:
        raise ValueError("not UTF-8") from None


def _order(declared: Mapping[str, Any]) -> float:
    """Place of a scenario among the others; the check of its package reports an order that is no number."""
    order = declared.get("order", LAST)
    return order if isinstance(order, int | float) else LAST


def _folder(spec: DomainSpec) -> Traversable:
    """The folder of a domain's scenario files."""
    folder = file(spec, "scenarios")
    if not folder.is_dir():
        raise UsageError(f"domain {spec.name}: scenarios = '{spec.scenarios}': no such folder")
    return folder


def _scenario_files(spec: DomainSpec) -> list[str]:
    return [entry.name.removesuffix(".toml") for entry in _folder(spec).iterdir() if entry.name.endswith(".toml")]


def _declaration(spec: DomainSpec, scenario: str) -> Mapping[str, Any]:
    """`declaration`, whose error names the file and is for users."""
    try:
        return declaration(spec, scenario)
    except ValueError as error:
        raise UsageError(f"domain {spec.name}: {spec.scenarios}/{scenario}.toml: {error}") from None
