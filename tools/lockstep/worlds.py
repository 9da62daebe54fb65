"""Simulated worlds of the scenarios: a robot's body at the scenario's start, and the scenario's scripted events."""

from __future__ import annotations

import importlib

from tailor.executive import domains
from tailor.simnodes.world import Event, World

# robot -> (module and class of its body, the domain whose scenarios it plays)
ROBOTS = {
    "agilo": ("tailor.simnodes.agilo.body", "AgiloBody", "soccer"),
    "powercube": ("tailor.simnodes.powercube.body", "PowerCubeBody", "arm"),
}


def make_world(robot: str, scenario: str, seed: int) -> World:
    """World of a scenario, sampled with the same seed and order of draws as the executive uses.

    Args:
      robot: A key of `ROBOTS`.
      scenario: One of the scenarios of the robot's domain; empty for the first.
      seed: Random seed of start, targets and noise.

    Raises:
      UsageError: The scenario is unknown.
    """
    module, kind, domain = ROBOTS[robot]
    name = scenario or domains.scenarios(domain)[0]
    sampled, start = domains.seeded_scenario(domain, name, seed)
    body = getattr(importlib.import_module(module), kind)()
    return World(body, start, seed, [_event(entry) for entry in sampled.settings.get("events", ())])


def _event(entry: dict[str, float]) -> Event:
    return Event(entry["at_s"], {name: value for name, value in entry.items() if name != "at_s"})
