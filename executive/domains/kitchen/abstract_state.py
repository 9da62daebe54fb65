"""Which predicates of the kitchen hold now: anchored in the belief, where it knows."""

from __future__ import annotations

from collections.abc import Iterator

from tailor.executive.domains.kitchen import places
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.interfaces.domain import Conflict, Scenario
from tailor.executive.interfaces.values import Fact

OBSERVED = ("cup-at", "holding", "hand-empty", "arm-home", "arm-out", "open", "free", "robot-at")


def anchor(belief: KitchenBelief, scenario: Scenario, remembered: frozenset[Fact]) -> frozenset[Fact]:
    """The abstract state of now; see tailor.executive.interfaces.domain.Domain.anchor.

    Settings of the scenario: `spots` by place, `cups`, `open_places` that need no reaching over, and `start`, the label
    of wherever the robot is when it stands before no place.
    """
    cups = tuple(_cups(belief, scenario, remembered))
    facts = {fact for fact in remembered if fact[0] not in OBSERVED} | set(cups)
    occupied = {fact[2] for fact in cups if fact[0] == "cup-at"}
    occupied |= places.blocked(belief, scenario, {fact[1] for fact in cups})
    facts |= {("free", label) for label in places.spots(scenario) if label not in occupied}
    if not belief.held:
        facts.add(("hand-empty",))
    stand = _stand(belief, scenario, remembered, cups)
    facts |= {("open", label) for label in scenario.settings["open_places"]}
    facts |= {("robot-at", stand)} | ({("arm-home",)} if belief.arm_is_home else {("arm-out",), ("open", stand)})
    return frozenset(facts)


def _cups(belief: KitchenBelief, scenario: Scenario, remembered: frozenset[Fact]) -> Iterator[Fact]:
    """Where each cup is: in the hand, at a place, or, if it is not seen, where it was, or where the map has it."""
    for cup in scenario.settings["cups"]:
        seen = belief.thing(cup)
        if belief.held == cup:
            yield ("holding", cup)
        elif seen is None:
            was_at = (fact[2] for fact in remembered if fact[0] == "cup-at" and fact[1] == cup)
            looked_for = next(was_at, places.mapped_label(scenario, cup))
            if looked_for is not None:
                yield ("cup-at", cup, looked_for)
        elif (label := places.place_of(belief, scenario, seen)) is not None:
            yield ("cup-at", cup, label)


def _stand(belief: KitchenBelief, scenario: Scenario, remembered: frozenset[Fact], cups: tuple[Fact, ...]) -> str:
    """The place before which the robot stands, as remembered, unless its arm does not reach the spot from there."""
    label = next((fact[1] for fact in remembered if fact[0] == "robot-at"), str(scenario.settings["start"]))
    if label not in places.spots(scenario):
        return label
    cup = next((fact[1] for fact in cups if fact[0] == "cup-at" and fact[2] == label), "")
    try:
        spot = places.cup_spot(belief, scenario, label, cup)[0] if cup else places.spot_of(belief, scenario, label)
    except Conflict:
        return str(scenario.settings["start"])
    return label if places.stands_before(belief, spot) else str(scenario.settings["start"])
