"""Results of searches that end without a plan."""

from __future__ import annotations

from tailor.executive.planning.plans.plan import Result


def goal_unreachable() -> Result:
    """Proof without a search: the relaxed planning graph does not reach the goal."""
    return Result("unsolvable", None, "the goal cannot be reached, not even without delete effects", 1, 0)


def search_exhausted(gap: str, pruned: bool, step_limit: int, generated: int, visited: int) -> Result:
    """Result of an empty search space: a proof, unless the space does not hold all plans.

    Args:
      gap: As of the plan space.
      pruned: Whether plans were dropped for having more than `step_limit` steps.
      step_limit: Maximum number of steps in a plan.
      generated: Number of plans generated.
      visited: Number of plans visited.
    """
    if gap:
        return Result("limit", None, gap, generated, visited)
    if pruned:
        return Result("limit", None, f"no plan of up to {step_limit} steps", generated, visited)
    return Result("unsolvable", None, "every partial plan has been refined to a dead end", generated, visited)
