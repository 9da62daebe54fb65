"""What the engine plans and validates, in unified-planning's words."""

from __future__ import annotations

from unified_planning.model import ProblemKind
from unified_planning.model.problem_kind_versioning import LATEST_PROBLEM_KIND_VERSION

_ANY = (
    "ACTION_BASED",
    "FLAT_TYPING",
    "HIERARCHICAL_TYPING",
    "NEGATIVE_CONDITIONS",
    "DISJUNCTIVE_CONDITIONS",
    "EQUALITIES",
    "EXISTENTIAL_CONDITIONS",
    "UNIVERSAL_CONDITIONS",
    "CONDITIONAL_EFFECTS",
    "FORALL_EFFECTS",
    # of static functions, which durations and costs read; what is not static is an effect or a condition of its own
    "INT_FLUENTS",
    "REAL_FLUENTS",
    "BOUNDED_TYPES",
    "ACTIONS_COST",
    "PLAN_LENGTH",
    "STATIC_FLUENTS_IN_ACTIONS_COST",
    "INT_NUMBERS_IN_ACTIONS_COST",
    "REAL_NUMBERS_IN_ACTIONS_COST",
    # of durative actions
    "CONTINUOUS_TIME",
    "DISCRETE_TIME",
    "DURATION_INEQUALITIES",
    "SELF_OVERLAPPING",
    "TIMED_EFFECTS",
    "STATIC_FLUENTS_IN_DURATIONS",
    "INT_TYPE_DURATIONS",
    "REAL_TYPE_DURATIONS",
    "MAKESPAN",
)


def supported_kind() -> ProblemKind:
    """Features of the problems that the engine plans and validates."""
    return ProblemKind(_ANY, version=LATEST_PROBLEM_KIND_VERSION)
