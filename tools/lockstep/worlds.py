"""Simulated worlds of the scenarios: a robot's body at the scenario's start, and the scenario's scripted events."""

from __future__ import annotations

from tailor.executive import domains
from tailor.executive.interfaces.domain import Scenario
from tailor.schemas.installed import part, spec_of_robot
from tailor.schemas.installed.package_errors import blamed_on_package
from tailor.simnodes.world import Event, World


def make_world(robot: str, scenario: str, seed: int) -> World:
    """World of a scenario, sampled with the same seed and order of draws as the executive uses.

    Args:
      robot: Name of a robot whose package has a body.
      scenario: One of the scenarios of the robot's domain; empty for the first.
      seed: Random seed of start, targets and noise.

    Raises:
      UsageError: Robot or scenario is unknown, or the robot has no body, or none that can be made.
    """
    spec = spec_of_robot(robot)
    with blamed_on_package(spec, f"the scenarios of {spec.name} cannot be listed"):
        name = scenario or domains.scenarios(spec.name)[0]
    with blamed_on_package(spec, f"scenario {name} of {spec.name} cannot be drawn"):
        sampled, start = domains.seeded_scenario(spec.name, name, seed)
        events = events_of(sampled)
    made = part(spec, "body")
    with blamed_on_package(spec, f"{spec.body}: cannot be simulated"):
        return World(made(), start, seed, events)


def events_of(scenario: Scenario) -> list[Event]:
    """Disturbances that were drawn for a scenario."""
    return [_event(entry) for entry in scenario.settings.get("events", ())]


def _event(entry: dict[str, float]) -> Event:
    return Event(entry["at_s"], {name: value for name, value in entry.items() if name != "at_s"})
