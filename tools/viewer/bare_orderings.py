"""The orderings of a plan that a drawing shows beside its causal links."""

from __future__ import annotations

from tailor.executive.planning import Plan


def bare_orderings(plan: Plan) -> list[tuple[int, int]]:
    """The orderings, which are closed, that neither a causal link nor two other orderings imply; sorted."""
    after: dict[int, set[int]] = {}
    for i, j in plan.orderings:
        after.setdefault(i, set()).add(j)
    linked = {(link.producer, link.consumer) for link in plan.links}
    implied = {i: set().union(*(after.get(k, set()) for k in later)) for i, later in after.items()}
    return sorted((i, j) for i, j in set(plan.orderings) - linked if j not in implied[i])
