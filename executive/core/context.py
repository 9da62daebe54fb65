"""What stays the same while the executive runs: domain, scenario, models, settings, identity."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from tailor.executive import planning
from tailor.executive.interfaces.domain import Domain, Scenario
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.schemas.errors import UsageError

PERIOD_NS = 100_000_000  # 10 Hz
MAX_GOAL_BYTES = 8000  # bytes: each status tells the goal, and must not become longer than its topic allows


@dataclass(frozen=True, slots=True)
class PlannerCommand:
    """A real `vhpop` that is asked before our own planner; `command` as in a shell, empty: there is none."""

    command: str = ""
    limit_s: float = 10.0  # then it is killed

    def __post_init__(self) -> None:
        if not (math.isfinite(self.limit_s) and self.limit_s > 0):
            raise UsageError(f"planner.limit_s is {self.limit_s:g}, expected seconds above 0")


@dataclass(frozen=True, slots=True)
class Settings:
    """Everything about the executive that a deployment may choose."""

    seed: int = 0
    refinement: RefinementSettings = field(default_factory=RefinementSettings)
    planner: planning.Settings = planning.DEFAULT
    external: PlannerCommand = field(default_factory=PlannerCommand)
    improve_plans: int = 20_000  # that a search for a better plan may generate while an action runs; 0: none does
    coast_ticks: int = 2  # how long the last command stands between two actions before zero
    replan_failures: int = 2  # this many failures in a row with one reason are a fault
    refine_while_running_s: float = 1.0  # for so long a better subgoal may still be adopted
    adopt_gain_s: float = 0.3  # and only if it is predicted to save this much
    overruns_to_hold: int = 3  # in one second

    def __post_init__(self) -> None:
        for name in ("seed", "improve_plans", "coast_ticks", "refine_while_running_s", "adopt_gain_s"):
            if not getattr(self, name) >= 0:  # so that nan is refused as well
                raise UsageError(f"executive.{name} is {getattr(self, name)}, expected at least 0")
        for name in ("replan_failures", "overruns_to_hold"):
            if getattr(self, name) < 1:
                raise UsageError(f"executive.{name} is {getattr(self, name)}, expected at least 1")


@dataclass(frozen=True, slots=True)
class Context:
    """The fixed part of every step."""

    domain: Domain
    scenario: Scenario
    models: Models
    pddl_domain: planning.Domain
    problem: planning.Problem
    settings: Settings
    sender: str  # this executive's sender id, 32 hex digits
    stamp_offset_ns: int = 0  # added to the monotonic time for the stamps of messages

    def stamp(self, now_ns: int) -> int:
        """The stamp of a message that is made at `now_ns`."""
        return now_ns + self.stamp_offset_ns


def make_context(
    domain: Domain, scenario: Scenario, models: Models, settings: Settings, sender: str, stamp_offset_ns: int = 0
) -> Context:
    """Read the domain's and the scenario's PDDL once; raises UsageError with line and column."""
    pddl_domain = planning.parse_domain(domain.pddl, f"domain {domain.name}")
    problem = planning.parse_problem(scenario.problem, pddl_domain, f"scenario {scenario.name}")
    return Context(domain, scenario, models, pddl_domain, problem, settings, sender, stamp_offset_ns)


def check_goal(context: Context, goal: str) -> str:
    """Why a PDDL goal cannot be accepted, or "" if it can."""
    length = len(goal.encode(errors="replace"))
    if length > MAX_GOAL_BYTES:
        return f"the goal has {length} bytes, expected at most {MAX_GOAL_BYTES}"
    try:
        context.problem.with_goal(goal)
    except planning.PddlError as error:
        return str(error)
    return ""
