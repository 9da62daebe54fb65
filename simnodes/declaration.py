"""What a driver declares of itself in `driver.toml`: which command it takes, and the limits that its guard enforces."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib import resources

from simnodes.guard import Limit


@dataclass(frozen=True, slots=True)
class Declaration:
    """A driver's command: its topic, and limits in the order of the axes."""

    command_topic: str  # name in schemas.topics
    limits: tuple[Limit, ...]


def declaration(robot: str) -> Declaration:
    """The declaration of a robot that ships with us."""
    text = resources.files("simnodes").joinpath(robot, "driver.toml").read_text(encoding="utf-8")
    table = tomllib.loads(text)
    axes = table["command"]["axes"]
    return Declaration(table["command"]["topic"], tuple(Limit(axis["lower"], axis["upper"]) for axis in axes))
