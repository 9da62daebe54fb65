"""Partial-order planning with PDDL and causal links, VHPOP-style (Younes & Simmons, JAIR 20, 2003).

The names below are the public interface. Each is loaded at its first use, so that a planner starts quickly.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tailor.executive.planning.anytime import AnytimeSearch
    from tailor.executive.planning.enumeration import PlanEnumeration
    from tailor.executive.planning.orders.every_order import UndecidedError, validate_every_order
    from tailor.executive.planning.pddl.domain_reader import parse_domain
    from tailor.executive.planning.pddl.language import Domain, Literal
    from tailor.executive.planning.pddl.problem import Problem
    from tailor.executive.planning.pddl.problem_reader import parse_problem
    from tailor.executive.planning.pddl.problem_text import format_problem
    from tailor.executive.planning.pddl.syntax.errors import PddlError, Unsupported
    from tailor.executive.planning.plan_quality import quality
    from tailor.executive.planning.plans.plan import GOAL, Link, Plan, Result, Step
    from tailor.executive.planning.plans.portions import PacedWork, Work
    from tailor.executive.planning.plans.vhpop_reader import PlanTextError, parse_plan
    from tailor.executive.planning.plans.vhpop_text import (
        EXCERPT_STEPS,
        format_excerpt,
        format_links,
        format_plan,
        number_of_steps,
    )
    from tailor.executive.planning.search import GroundCache, Search
    from tailor.executive.planning.semantics.action_effects import apply_action, too_large_to_execute
    from tailor.executive.planning.semantics.completion import completed, completion
    from tailor.executive.planning.semantics.state import Objects
    from tailor.executive.planning.semantics.suffix import relink, shortest_suffix, suffix
    from tailor.executive.planning.semantics.validator import validate, validation
    from tailor.executive.planning.settings import DEFAULT, MATCHING, EngineName, FlawOrder, Settings

__all__ = [
    "DEFAULT",
    "EXCERPT_STEPS",
    "GOAL",
    "MATCHING",
    "AnytimeSearch",
    "Domain",
    "EngineName",
    "FlawOrder",
    "GroundCache",
    "Link",
    "Literal",
    "Objects",
    "PacedWork",
    "PddlError",
    "Plan",
    "PlanEnumeration",
    "PlanTextError",
    "Problem",
    "Result",
    "Search",
    "Settings",
    "Step",
    "UndecidedError",
    "Unsupported",
    "Work",
    "apply_action",
    "completed",
    "completion",
    "format_excerpt",
    "format_links",
    "format_plan",
    "format_problem",
    "number_of_steps",
    "parse_domain",
    "parse_plan",
    "parse_problem",
    "quality",
    "relink",
    "shortest_suffix",
    "suffix",
    "too_large_to_execute",
    "validate",
    "validate_every_order",
    "validation",
]

_MODULES = {
    "AnytimeSearch": "anytime",
    "quality": "plan_quality",
    "apply_action": "semantics.action_effects",
    "too_large_to_execute": "semantics.action_effects",
    "completed": "semantics.completion",
    "completion": "semantics.completion",
    "DEFAULT": "settings",
    "Domain": "pddl.language",
    "EngineName": "settings",
    "EXCERPT_STEPS": "plans.vhpop_text",
    "FlawOrder": "settings",
    "format_excerpt": "plans.vhpop_text",
    "format_links": "plans.vhpop_text",
    "format_plan": "plans.vhpop_text",
    "format_problem": "pddl.problem_text",
    "GOAL": "plans.plan",
    "GroundCache": "search",
    "Link": "plans.plan",
    "Literal": "pddl.language",
    "MATCHING": "settings",
    "number_of_steps": "plans.vhpop_text",
    "Objects": "semantics.state",
    "PacedWork": "plans.portions",
    "parse_domain": "pddl.domain_reader",
    "parse_plan": "plans.vhpop_reader",
    "parse_problem": "pddl.problem_reader",
    "PddlError": "pddl.syntax.errors",
    "Plan": "plans.plan",
    "PlanEnumeration": "enumeration",
    "PlanTextError": "plans.vhpop_reader",
    "Problem": "pddl.problem",
    "relink": "semantics.suffix",
    "Result": "plans.plan",
    "Search": "search",
    "Settings": "settings",
    "shortest_suffix": "semantics.suffix",
    "Step": "plans.plan",
    "suffix": "semantics.suffix",
    "UndecidedError": "orders.every_order",
    "Unsupported": "pddl.syntax.errors",
    "validate": "semantics.validator",
    "validate_every_order": "orders.every_order",
    "validation": "semantics.validator",
    "Work": "plans.portions",
}


def __getattr__(name: str) -> Any:
    """Loads a name of the public interface."""
    if name not in _MODULES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = globals()[name] = getattr(importlib.import_module(f"{__name__}.{_MODULES[name]}"), name)
    return value
