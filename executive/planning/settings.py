"""What a user may choose about the search, in VHPOP's words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal as OneOf

from tailor.executive.planning.flaws.flaw_orders import parse_flaw_order
from tailor.executive.planning.flaws.ranking import check_rankings
from tailor.schemas.errors import UsageError

MIN_TICK_S = 1e-6  # PDDL's longest duration is 1e15 of these, and a plan's bounds must stay below UNBOUNDED


@dataclass(frozen=True, slots=True)
class FlawOrder:
    """A flaw selection order by name or notation, and how many plans it may generate (None: no limit of its own)."""

    text: str
    limit: int | None = None


@dataclass(frozen=True, slots=True)
class Settings:
    """All options of a search; a wrong one raises `UsageError` when the settings are made.

    An empty `rankings` is ADDR/ADDR_WORK/BUC/LIFO, or ADDR/MAKESPAN/LIFO when the problem's metric is the makespan.
    Several flaw orders take turns (round robin). `weight` is of the heuristic against the cost of the steps.
    `node_limit` bounds the plans generated, `step_limit` their steps, `ground_limit` the bindings that grounding
    tries; `tolerance_s` is one tick of a durative plan.
    """

    rankings: tuple[str, ...] = ()
    flaw_orders: tuple[FlawOrder, ...] = (FlawOrder("MW-Loc"), FlawOrder("LCFR-Loc-Conf"))
    search: OneOf["A", "IDA"] = "A"
    ground: bool = True
    weight: float = 1.0
    action_cost: OneOf["unit", "duration", "relative"] = "unit"
    node_limit: int = 100_000
    step_limit: int = 200
    ground_limit: int = 100_000
    tolerance_s: float = 0.01
    seed: int = 0
    random_open_conditions: bool = False

    def __post_init__(self) -> None:
        if not self.flaw_orders:
            raise UsageError("planner settings: expected at least one flaw order")
        for order in self.flaw_orders:
            parse_flaw_order(order.text)
        check_rankings(self.rankings)
        if not 0 <= self.weight < math.inf:
            raise UsageError(f"planner settings: expected a finite weight of at least 0, found {self.weight}")
        if not MIN_TICK_S <= self.tolerance_s <= 1e3:
            raise UsageError(f"planner settings: expected a tolerance in [1e-6, 1000] s, found {self.tolerance_s}")
        if self.seed < 0:
            raise UsageError(f"planner settings: expected a seed of at least 0, found {self.seed}")
        for name in ("node_limit", "step_limit", "ground_limit"):
            if getattr(self, name) < 0:
                raise UsageError(f"planner settings: expected {name} to be at least 0, found {getattr(self, name)}")


DEFAULT_RANKINGS = ("ADDR", "ADDR_WORK", "BUC", "LIFO")
MAKESPAN_RANKINGS = ("ADDR", "MAKESPAN", "LIFO")
DEFAULT = Settings()
MATCHING = Settings(DEFAULT_RANKINGS, (FlawOrder("MW-Loc"),))  # the reference's `g-mwloc`


def rankings_for(settings: Settings, metric: str) -> tuple[str, ...]:
    """The rankings that the settings name, or those that go with the problem's metric."""
    if settings.rankings:
        return settings.rankings
    return MAKESPAN_RANKINGS if metric == "makespan" else DEFAULT_RANKINGS
