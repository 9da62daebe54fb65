"""Interface of a plan space, as both search algorithms use it."""

from __future__ import annotations

from typing import Protocol, TypeVar

from tailor.executive.planning.flaws.ranking import Rank
from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.structures.refinable import Refinable

P = TypeVar("P", bound=Refinable)


class PlanSpace(Protocol[P]):
    """Partial plans of type P and their refinements."""

    def initial(self) -> P:
        """The root of the search: a plan without steps."""
        ...

    def is_complete(self, plan: P) -> bool:
        """Whether a plan without flaws can be executed."""
        ...

    def gap(self) -> str:
        """Why a space without solutions is no proof that there is none; "" if it is: every plan is below the root."""
        ...

    def refine(self, plan: P, order: int) -> list[P]:
        """All resolvers of the flaw that the order-th flaw order selects."""
        ...

    def rank(self, plan: P, number: int) -> Rank | None:
        """The rank of the `number`-th plan generated; None if no solution is below it."""
        ...

    def extract(self, plan: P) -> Plan:
        """The finished plan, with actions and links by name."""
        ...
