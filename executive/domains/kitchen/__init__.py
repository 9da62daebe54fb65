"""Fetching and delivering cups in a kitchen with the B21 (paper 2, 6.3)."""

from __future__ import annotations

from importlib import resources

from tailor.executive.domains.kitchen.domain import KitchenDomain


def make() -> KitchenDomain:
    """The domain as it ships."""
    return KitchenDomain(pddl=resources.files(__package__).joinpath("domain.pddl").read_text(encoding="utf-8"))
