"""What the arm's predicates mean: the values that they give a waypoint (paper 6.1)."""

from __future__ import annotations

from collections.abc import Mapping

from executive.domains.arm.belief import ArmBelief
from executive.library import Fact, Interval, Scenario


def value(quantity: str, label: str, holds: tuple[Fact, ...], belief: ArmBelief, scenario: Scenario) -> Interval | None:
    """See executive.library.Domain.value.

    `at` says where the arm is, `next` where the scenario put the waypoint; the velocities at a waypoint are free
    unless the scenario names them, which it does for the last.
    """
    known: Mapping[str, float] = {}
    if ("at", label) in holds:
        known = state(belief)
    elif any(fact[0] == "next" and fact[2] == label for fact in holds):
        known = scenario.places[label]
    return Interval(known[quantity], known[quantity]) if quantity in known else None


def state(belief: ArmBelief) -> dict[str, float]:
    """The believed joint state by quantity."""
    (a, b), (wa, wb) = belief.angles, belief.velocities
    return {"a": a, "wa": wa, "b": b, "wb": wb}
