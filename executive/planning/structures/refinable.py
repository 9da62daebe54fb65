"""Interface of a partial plan, ground or lifted, as searches, rankings and flaw orders read it."""

from __future__ import annotations

from collections.abc import Sized
from typing import Any, Protocol

from tailor.executive.planning.structures.orderings import Orderings


class Refinable(Protocol):
    """A partial plan; its flaws are linked lists, the newest at the head."""

    @property
    def steps(self) -> Sized:
        """Its actions."""
        ...

    @property
    def orderings(self) -> Orderings:
        """Their order."""
        ...

    @property
    def open(self) -> Any:
        """The newest open condition."""
        ...

    @property
    def threats(self) -> Any:
        """The newest threat."""
        ...

    @property
    def open_count(self) -> int:
        """The number of open conditions."""
        ...

    @property
    def threat_count(self) -> int:
        """The number of threats."""
        ...

    @property
    def cost(self) -> float:
        """The cost of the steps."""
        ...
