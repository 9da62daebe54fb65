"""The planner as a library: parse PDDL, ground and search in portions, validate and explain plans.

Every public name of `tailor.executive.planning`, and the budget that the searches are advanced with. A name is loaded
at its first use, so the import itself takes no time. `docs/planning.md` has an example.
"""

from typing import TYPE_CHECKING, Any

from tailor.executive import planning
from tailor.executive.interfaces.budget import Budget, CheckBudget

if TYPE_CHECKING:
    from tailor.executive.planning import (
        DEFAULT,
        EXCERPT_STEPS,
        GOAL,
        MATCHING,
        AnytimeSearch,
        Domain,
        EngineName,
        FlawOrder,
        GroundCache,
        Link,
        Literal,
        Objects,
        PacedWork,
        PddlError,
        Plan,
        PlanEnumeration,
        PlanTextError,
        Problem,
        Result,
        Search,
        Settings,
        Step,
        UndecidedError,
        Unsupported,
        Work,
        apply_action,
        completed,
        completion,
        format_excerpt,
        format_links,
        format_plan,
        format_problem,
        number_of_steps,
        parse_domain,
        parse_plan,
        parse_problem,
        quality,
        relink,
        shortest_suffix,
        suffix,
        validate,
        validate_every_order,
        validation,
    )

__all__ = [
    "DEFAULT",
    "EXCERPT_STEPS",
    "GOAL",
    "MATCHING",
    "AnytimeSearch",
    "Budget",
    "CheckBudget",
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
    "validate",
    "validate_every_order",
    "validation",
]


def __getattr__(name: str) -> Any:
    """Loads a public name."""
    if name not in __all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = globals()[name] = getattr(planning, name)
    return value


def __dir__() -> list[str]:
    """The public names, for interpreters that complete them."""
    return sorted(__all__)
