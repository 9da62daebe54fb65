"""Values of the arm's predicates: the joint state that they give a waypoint (paper 6.1)."""

from __future__ import annotations

from collections.abc import Mapping

from tailor.executive.domains.arm.belief import ahead
from tailor.executive.domains.arm.load import TRAINED_FRICTION, Joints
from tailor.executive.interfaces.domain import LabelQuery
from tailor.executive.interfaces.values import Interval

FRICTIONS = ("fa", "fb")


def value(query: LabelQuery) -> Interval | None:
    """Range of a quantity of a waypoint in rad or rad/s; see tailor.executive.interfaces.domain.Domain.value.

    `at` gives the joint state predicted for the start of the next action, `next` the waypoint of the scenario. The
    velocities at a waypoint are free up to the maximum that its neighbours allow, unless the scenario gives them, as it
    does for the last waypoint. Friction is that of the gears as it is believed, at any waypoint.
    """
    values: Mapping[str, float] = {}
    if query.quantity in FRICTIONS:
        values = frictions(query.belief.friction)
    elif ("at", query.label) in query.holds:
        values = named(*ahead(query.belief))
    elif any(fact[0] == "next" and fact[2] == query.label for fact in query.holds):
        values = query.scenario.places[query.label]
    if query.quantity in values:
        exact = values[query.quantity]
        return Interval(exact, exact)
    return Interval(-values["fastest"], values["fastest"]) if "fastest" in values else None


def named(angles: Joints, velocities: Joints) -> dict[str, float]:
    """A joint state by quantity, in the order of the paper's Table 6."""
    (a, b), (wa, wb) = angles, velocities
    return {"a": a, "wa": wa, "b": b, "wb": wb}


def frictions(friction: Joints) -> dict[str, float]:
    """Friction of the gears by quantity, within what models are asked for."""
    lowest, highest = TRAINED_FRICTION
    return {name: max(lowest, min(highest, factor)) for name, factor in zip(FRICTIONS, friction, strict=True)}
