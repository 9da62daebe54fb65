"""Settings of a search, named as VHPOP names them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal as OneOf

from tailor.executive.planning.flaws.flaw_orders import parse_flaw_order
from tailor.executive.planning.flaws.ranking import check_rankings
from tailor.executive.planning.ground.ground_formula import MAX_STEPS
from tailor.schemas.errors import UsageError

EngineName = OneOf["auto", "pocl", "forward"]
MIN_TICK_S = 1e-6  # PDDL's longest duration is 1e15 of these, and a plan's bounds must stay below UNBOUNDED
MAX_TICK_S = 1e3
MAX_WEIGHT = 1e100  # the largest estimate is 1e200, and a rank must stay finite: an infinite one is never searched


@dataclass(frozen=True, slots=True)
class FlawOrder:
    """A flaw selection order by name or notation, with its own limit of generated plans (None: no limit)."""

    text: str
    limit: int | None = None


@dataclass(frozen=True, slots=True)
class Settings:
    """All options of a search.

    Attributes:
      rankings: Compared from left to right, smallest first. Empty: ADDR/ADDR_WORK/BUC/LIFO, or ADDR/MAKESPAN/LIFO if
        the problem's metric is the makespan.
      flaw_orders: One or more; several are used in round robin.
      search: A* ("A") or IDA* ("IDA").
      ground: Plan with ground actions; False: with variables (lifted).
      weight: Weight of the heuristic against the cost of the steps, in [0, 1e100].
      action_cost: Cost of a step: 1, its duration in seconds, its duration relative to the shortest action, or what it
        adds to (total-cost).
      node_limit: Maximum number of generated plans, and of evaluated states.
      step_limit: Maximum number of steps in a plan.
      engine: Partial-order search ("pocl"), search through states ("forward": no durations, disjunctions or
        conditional effects), or both by turns ("auto").
      ground_limit: Maximum number of steps of grounding (formulas over objects); the default takes a third of a second.
      tolerance_s: Least time between dependent events of a durative plan (one tick), in [1e-6, 1000] s.
      seed: Random seed, at least 0.
      random_open_conditions: Open an action's conditions in random order.

    Raises:
      UsageError: An option is out of its range.
    """

    rankings: tuple[str, ...] = ()
    flaw_orders: tuple[FlawOrder, ...] = (FlawOrder("MW-Loc"), FlawOrder("LCFR-Loc-Conf"))
    search: OneOf["A", "IDA"] = "A"
    ground: bool = True
    weight: float = 1.0
    action_cost: OneOf["unit", "duration", "relative", "metric"] = "unit"
    node_limit: int = 100_000
    step_limit: int = 200
    ground_limit: int = MAX_STEPS
    tolerance_s: float = 0.01
    seed: int = 0
    random_open_conditions: bool = False
    engine: EngineName = "auto"

    def __post_init__(self) -> None:
        if not self.flaw_orders:
            raise UsageError("planner settings: expected at least one flaw order")
        for order in self.flaw_orders:
            parse_flaw_order(order.text)
            if order.limit is not None and order.limit < 0:
                raise UsageError(
                    f"planner settings: expected a limit of flaw orders of at least 0, found {order.limit}"
                )
        check_rankings(self.rankings)
        if not 0 <= self.weight <= MAX_WEIGHT:
            raise UsageError(f"planner settings: expected a weight in [0, {MAX_WEIGHT:g}], found {self.weight}")
        if not MIN_TICK_S <= self.tolerance_s <= MAX_TICK_S:
            raise UsageError(f"planner settings: expected a tolerance in [1e-6, 1000] s, found {self.tolerance_s}")
        if self.seed < 0:
            raise UsageError(f"planner settings: expected a seed of at least 0, found {self.seed}")
        for name in ("node_limit", "step_limit", "ground_limit"):
            if getattr(self, name) < 0:
                raise UsageError(f"planner settings: expected {name} to be at least 0, found {getattr(self, name)}")


DEFAULT_RANKINGS = ("ADDR", "ADDR_WORK", "BUC", "LIFO")
MAKESPAN_RANKINGS = ("ADDR", "MAKESPAN", "LIFO")
DEFAULT = Settings()
MATCHING = Settings(DEFAULT_RANKINGS, (FlawOrder("MW-Loc"),), engine="pocl")  # the reference's `g-mwloc`


def rankings_for(settings: Settings, metric: str) -> tuple[str, ...]:
    """The rankings of the settings, or the default rankings of the problem's metric."""
    if settings.rankings:
        return settings.rankings
    return MAKESPAN_RANKINGS if metric == "makespan" else DEFAULT_RANKINGS
