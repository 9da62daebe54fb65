"""Writing with the PowerCube arm: reaches through waypoints whose joint velocities are free (paper 6.3, Figure 13)."""

from __future__ import annotations

from importlib import resources

from tailor.executive.domains.arm.domain import ArmDomain
from tailor.executive.domains.arm.letters import load_scenario, scenarios

__all__ = ["load_scenario", "make", "scenarios"]


def make() -> ArmDomain:
    """The domain as it ships."""
    return ArmDomain(pddl=resources.files(__package__).joinpath("domain.pddl").read_text(encoding="utf-8"))
