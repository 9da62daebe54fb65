"""Results of searches that end without a plan."""

from __future__ import annotations

from tailor.executive.planning.plans.plan import Result


def goal_unreachable() -> Result:
    """Proof without a search: the relaxed planning graph does not reach the goal."""
    return Result("unsolvable", None, "the goal cannot be reached, not even without delete effects", 1, 0)


def search_exhausted(pruned: bool, step_limit: int, generated: int, visited: int) -> Result:
    """Result of an empty search space: a proof, unless plans were pruned for having more than `step_limit` steps."""
    if pruned:
        return Result("limit", None, f"no plan of up to {step_limit} steps", generated, visited)
    return Result("unsolvable", None, "every partial plan has been refined to a dead end", generated, visited)
