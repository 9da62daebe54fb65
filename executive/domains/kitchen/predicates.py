"""The kitchen's predicates: the values that they give a place (paper 6.1, 6.3)."""

from __future__ import annotations

import math
from collections.abc import Mapping

from tailor.executive.belief.angles import difference
from tailor.executive.domains.kitchen import places, robot
from tailor.executive.domains.kitchen.action_library import ASIDE_RAD
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.interfaces.domain import LabelQuery
from tailor.executive.interfaces.values import Interval
from tailor.schemas.kitchen.kinematics import V_MAX_MPS

STAND = ("x", "y", "phi", "v")
HAND = ("hand_x", "hand_y", "hand_aside")  # where the hand is, whatever the label
YES, NO = Interval(1.0, 1.0), Interval(0.0, 0.0)


def value(query: LabelQuery) -> Interval | None:
    """Range of a quantity of a place; see tailor.executive.interfaces.domain.Domain.value.

    A stand is where the robot is, or anywhere from which the arm reaches the place's spot: 0.4 to 0.8 m from the table.
    """
    if query.quantity == "seen":
        return YES if query.belief.thing("stool") is not None else NO
    if query.quantity in STAND:
        return _stand(query).get(query.quantity)
    if query.quantity in HAND:
        return _hand(query.belief)[query.quantity]
    if query.quantity == "out":
        return YES if ("open", query.label) in query.achieved or not query.belief.arm_is_home else NO
    if query.quantity == "aside":
        return _aside(query)
    return _spot(query).get(query.quantity)


def _aside(query: LabelQuery) -> Interval | None:
    """Where an arm that is out over the place points, as well as it can; elsewhere it would have to swing first."""
    if query.belief.arm_is_home or ("robot-at", query.label) not in query.holds:
        return None
    spot = _spot(query)
    x, y = (0.5 * (spot[name].lower + spot[name].upper) for name in ("spot_x", "spot_y"))
    return _pointing(query.belief, *query.belief.in_base(x, y))


def _pointing(belief: KitchenBelief, ahead: float, left: float) -> Interval:
    """How far aside of the line from the shoulder to a place in base_link (m) the hand points."""
    c, s, _ = robot.ARM.forward(belief.angles).turn[0]
    aside = difference(math.atan2(s, c), math.atan2(left, ahead - robot.AHEAD_M))
    return Interval(*(max(-ASIDE_RAD, min(ASIDE_RAD, aside)),) * 2)


def _hand(belief: KitchenBelief) -> Mapping[str, Interval]:
    x, y, _ = belief.hand
    ahead, left, _ = robot.ARM.forward(belief.angles).place
    return {**_exact({"hand_x": x, "hand_y": y}), "hand_aside": _pointing(belief, ahead, left)}


def _stand(query: LabelQuery) -> Mapping[str, Interval]:
    if ("robot-at", query.label) in query.holds:
        return _exact(_robot(query.belief))
    if query.label not in places.spots(query.scenario):
        return _exact(places.open_stand(query.scenario, query.label))
    cup = _cup(query)
    if cup:
        return places.stand_ranges(places.cup_spot(query.belief, query.scenario, query.label, cup)[0])
    return places.stand_ranges(places.spot_of(query.belief, query.scenario, query.label))


def _spot(query: LabelQuery) -> Mapping[str, Interval]:
    """Where the cup stands and how its handle points, or where it may be put."""
    cup = _cup(query)
    if cup:
        spot, handle = places.cup_spot(query.belief, query.scenario, query.label, cup)
        return _exact({"spot_x": spot.x, "spot_y": spot.y, "handle": handle})
    return places.put_ranges(places.spot_of(query.belief, query.scenario, query.label))


def _cup(query: LabelQuery) -> str:
    """The cup that stands at the place now; "": none does."""
    return next((fact[1] for fact in query.holds if fact[0] == "cup-at" and fact[2] == query.label), "")


def _robot(belief: KitchenBelief) -> dict[str, float]:
    pose = belief.pose
    return {"x": pose.x, "y": pose.y, "phi": pose.phi, "v": max(0.0, min(V_MAX_MPS, belief.v))}


def _exact(values: Mapping[str, float]) -> dict[str, Interval]:
    return {name: Interval(number, number) for name, number in values.items()}
