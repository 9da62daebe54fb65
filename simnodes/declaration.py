"""What a driver declares of itself in `driver.toml`: which command it takes, and the limits that its guard enforces."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib import resources

from simnodes.guard import Limit


@dataclass(frozen=True, slots=True)
class Declaration:
    """A driver's command: its topic, and its axes with their limits, in one order."""

    command_topic: str  # name in schemas.topics
    axes: tuple[str, ...]
    limits: tuple[Limit, ...]
    timeout_ns: int = 300_000_000


def declaration(robot: str) -> Declaration:
    """The declaration of a robot that ships with us."""
    return read_declaration(resources.files("simnodes").joinpath(robot, "driver.toml").read_text(encoding="utf-8"))


def read_declaration(text: str) -> Declaration:
    """A declaration from its TOML text; raises KeyError, TypeError or ValueError where it is none."""
    command = tomllib.loads(text)["command"]
    return Declaration(
        command_topic=command["topic"],
        axes=tuple(axis["name"] for axis in command["axes"]),
        limits=tuple(Limit(axis["lower"], axis["upper"]) for axis in command["axes"]),
        timeout_ns=round(command["timeout_s"] * 1e9),
    )
