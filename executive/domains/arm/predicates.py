"""What the arm's predicates mean: the values that they give a waypoint (paper 6.1)."""

from __future__ import annotations

from collections.abc import Mapping

from tailor.executive.domains.arm.belief import Joints, ahead
from tailor.executive.interfaces.domain import LabelQuery
from tailor.executive.interfaces.values import Interval


def value(query: LabelQuery) -> Interval | None:
    """See tailor.executive.interfaces.domain.Domain.value.

    `at` says where the arm will be when the next action begins, `next` where the scenario put the waypoint. The
    velocities at a waypoint are free up to the fastest that its neighbours allow, unless the scenario names them, which
    it does for the last.
    """
    known: Mapping[str, float] = {}
    if ("at", query.label) in query.holds:
        known = named(*ahead(query.belief))
    elif any(fact[0] == "next" and fact[2] == query.label for fact in query.holds):
        known = query.scenario.places[query.label]
    if query.quantity in known:
        exact = known[query.quantity]
        return Interval(exact, exact)
    return Interval(-known["fastest"], known["fastest"]) if "fastest" in known else None


def named(angles: Joints, velocities: Joints) -> dict[str, float]:
    """A joint state by quantity, in the order of the paper's Table 6."""
    (a, b), (wa, wb) = angles, velocities
    return {"a": a, "wa": wa, "b": b, "wb": wb}
