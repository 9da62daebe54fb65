"""Partial-order planning with PDDL and causal links, VHPOP-style (Younes & Simmons, JAIR 20, 2003).

The names below are the public interface. Each is loaded at its first use, so that a planner starts quickly.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tailor.executive.planning.pddl.domain_reader import parse_domain
    from tailor.executive.planning.pddl.errors import PddlError, Unsupported
    from tailor.executive.planning.pddl.language import Domain, Literal
    from tailor.executive.planning.pddl.problem import Problem
    from tailor.executive.planning.pddl.problem_reader import parse_problem
    from tailor.executive.planning.pddl.problem_text import format_problem
    from tailor.executive.planning.plans.action_effects import apply_action
    from tailor.executive.planning.plans.completion import completed
    from tailor.executive.planning.plans.plan import GOAL, Link, Plan, Result, Step
    from tailor.executive.planning.plans.suffix import relink, suffix
    from tailor.executive.planning.plans.validator import validate
    from tailor.executive.planning.plans.vhpop_reader import PlanTextError, parse_plan
    from tailor.executive.planning.plans.vhpop_text import format_links, format_plan
    from tailor.executive.planning.search import GroundCache, Search
    from tailor.executive.planning.settings import DEFAULT, MATCHING, EngineName, FlawOrder, Settings

__all__ = [
    "DEFAULT",
    "GOAL",
    "MATCHING",
    "Domain",
    "EngineName",
    "FlawOrder",
    "GroundCache",
    "Link",
    "Literal",
    "PddlError",
    "Plan",
    "PlanTextError",
    "Problem",
    "Result",
    "Search",
    "Settings",
    "Step",
    "Unsupported",
    "apply_action",
    "completed",
    "format_links",
    "format_plan",
    "format_problem",
    "parse_domain",
    "parse_plan",
    "parse_problem",
    "relink",
    "suffix",
    "validate",
]

_MODULES = {
    "apply_action": "plans.action_effects",
    "completed": "plans.completion",
    "DEFAULT": "settings",
    "Domain": "pddl.language",
    "EngineName": "settings",
    "FlawOrder": "settings",
    "format_links": "plans.vhpop_text",
    "format_plan": "plans.vhpop_text",
    "format_problem": "pddl.problem_text",
    "GOAL": "plans.plan",
    "GroundCache": "search",
    "Link": "plans.plan",
    "Literal": "pddl.language",
    "MATCHING": "settings",
    "parse_domain": "pddl.domain_reader",
    "parse_plan": "plans.vhpop_reader",
    "parse_problem": "pddl.problem_reader",
    "PddlError": "pddl.errors",
    "Plan": "plans.plan",
    "PlanTextError": "plans.vhpop_reader",
    "Problem": "pddl.problem",
    "relink": "plans.suffix",
    "Result": "plans.plan",
    "Search": "search",
    "Settings": "settings",
    "Step": "plans.plan",
    "suffix": "plans.suffix",
    "Unsupported": "pddl.errors",
    "validate": "plans.validator",
}


def __getattr__(name: str) -> Any:
    """Loads a name of the public interface."""
    if name not in _MODULES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(importlib.import_module(f"{__name__}.{_MODULES[name]}"), name)
