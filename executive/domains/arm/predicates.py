"""What the arm's predicates mean: the values that they give a waypoint (paper 6.1)."""

from __future__ import annotations

from collections.abc import Mapping

from tailor.executive.domains.arm.belief import ArmBelief, Joints, ahead
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.interfaces.values import Fact, Interval


def value(quantity: str, label: str, holds: tuple[Fact, ...], belief: ArmBelief, scenario: Scenario) -> Interval | None:
    """See tailor.executive.interfaces.domain.Domain.value.

    `at` says where the arm will be when the next action begins, `next` where the scenario put the waypoint. The
    velocities at a waypoint are free up to the fastest that its neighbours allow, unless the scenario names them, which
    it does for the last.
    """
    known: Mapping[str, float] = {}
    if ("at", label) in holds:
        known = named(*ahead(belief))
    elif any(fact[0] == "next" and fact[2] == label for fact in holds):
        known = scenario.places[label]
    if quantity in known:
        return Interval(known[quantity], known[quantity])
    return Interval(-known["fastest"], known["fastest"]) if "fastest" in known else None


def named(angles: Joints, velocities: Joints) -> dict[str, float]:
    """A joint state by quantity, in the order of the paper's Table 6."""
    (a, b), (wa, wb) = angles, velocities
    return {"a": a, "wa": wa, "b": b, "wb": wb}
