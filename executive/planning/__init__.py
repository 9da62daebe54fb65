"""Partial-order planning with PDDL and causal links, VHPOP-style (Younes & Simmons, JAIR 20, 2003).

The names below are the public interface.
"""

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
