"""Robot soccer with the AGILO robot: approach a ball and dribble it somewhere, or drive a route (paper 6.4)."""

from __future__ import annotations

from importlib import resources

from tailor.executive.domains.soccer.domain import SoccerDomain
from tailor.executive.domains.soccer.scenario_sampling import sample_scenario

__all__ = ["make", "sample_scenario"]


def make() -> SoccerDomain:
    """The domain as it ships."""
    return SoccerDomain(pddl=resources.files(__package__).joinpath("domain.pddl").read_text())
