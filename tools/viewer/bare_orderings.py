"""The orderings of a plan that a drawing shows beside its causal links."""

from __future__ import annotations

from tailor.executive.planning import Plan
from tailor.tools.plan_search.transitive_reduction import transitive_reduction


def bare_orderings(plan: Plan) -> list[tuple[int, int]]:
    """The orderings, which are closed, that neither a causal link nor two other orderings imply; sorted."""
    linked = {(link.producer, link.consumer) for link in plan.links}
    return [ordering for ordering in transitive_reduction(plan.orderings) if ordering not in linked]
