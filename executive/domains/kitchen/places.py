"""Places of a scenario: spots for cups on tables, and the stands before them from which the arm reaches them."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from tailor.executive.belief.angles import difference, wrap
from tailor.executive.domains.kitchen import objects
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.domains.kitchen.known_places import mapped_cup, table_place
from tailor.executive.domains.kitchen.objects import Thing
from tailor.executive.interfaces.domain import Conflict, Scenario
from tailor.executive.interfaces.values import Interval
from tailor.schemas.kitchen.furniture import Place, kitchen, on_table

TABLE_M = (0.4, 0.8)  # from the robot's middle to the table, when it grips or puts (paper 6.3)
TILT_M = 0.03  # a table that is turned a little is nearer at one end of a stand's range: kept off both ends
REACH_M = 0.88  # from the robot's middle to the spot's line: drives end up to 4 cm beside a stand, looking aside
LATERAL_M = 0.12  # how far beside the spot the robot may stand
FACING_RAD = 0.5  # how far it may look aside of the table
SPOT_M = (0.03, 0.06)  # how far from its spot a cup may be put, along the table's direction and across
ON_TOP_M = 0.06  # height above the table's top by which a cup may be misjudged
BLOCKED_M = 0.15  # a cup so near a spot is knocked over by one that is put there; those of neighbouring slots are not
UNSEEN_M = 0.2  # by which a table may be off the map: as far as it is displaced and turned, and as a cup is seen
# Beyond the ranges of a stand the robot still counts as being there: more than what goToPose leaves, or it would be
# sent again to where it has arrived.
SLACK_M, SLACK_RAD = 0.07, 0.25
Ranges = Mapping[str, Interval]


@dataclass(frozen=True, slots=True)
class Spot:
    """A spot as it is believed: its table's pose, and its own position (m, map frame)."""

    table: Place
    x: float
    y: float

    @property
    def from_edge_m(self) -> float:
        """Distance to the edge at which the robot stands."""
        c, s = math.cos(self.table[2]), math.sin(self.table[2])
        return kitchen().edge_m - (c * (self.x - self.table[0]) + s * (self.y - self.table[1]))


def spots(scenario: Scenario) -> Mapping[str, tuple[str, int]]:
    """Table and number of the slot of each place that has a spot."""
    declared: Mapping[str, tuple[str, int]] = scenario.settings["spots"]
    return declared


def mapped_label(scenario: Scenario, cup: str) -> str | None:
    """Place at which a cup stands by the map of the kitchen: lost ones are looked for there. None: at none."""
    table, slot, _ = kitchen().cups[cup]
    return next((label for label, place in spots(scenario).items() if tuple(place) == (table, slot)), None)


def open_stand(scenario: Scenario, label: str) -> Mapping[str, float]:
    """Where the robot stands at a place without a spot.

    Raises:
      Conflict: Nobody says where that is, e.g. the place from which the robot started: a goal may send it back there.
    """
    if label not in scenario.places:
        raise Conflict(f"{label} has no stand")
    return scenario.places[label]


def spot_of(belief: KitchenBelief, scenario: Scenario, label: str) -> Spot:
    """The believed spot of a place without a cup.

    Raises:
      Conflict: The place has none, e.g. that from which the robot started: a goal may ask the arm to reach there.
    """
    if label not in spots(scenario):
        raise Conflict(f"{label} has no spot for a cup")
    name, slot = spots(scenario)[label]
    table = table_place(belief, name)
    x, y, _ = on_table(table, *kitchen().table.slots[slot])
    return Spot(table, x, y)


def cup_spot(belief: KitchenBelief, scenario: Scenario, label: str, cup: str) -> tuple[Spot, float]:
    """Spot of the cup that stands at a place, and direction of its handle; where it is not seen yet, the map's.

    Raises:
      Conflict: The cup is not known to stand there.
    """
    if belief.held == cup:
        raise Conflict(f"{cup} is in the gripper")
    table, seen = table_place(belief, spots(scenario)[label][0]), belief.thing(cup)
    if seen is not None:
        return Spot(table, seen.x, seen.y), seen.phi
    if kitchen().cups[cup][0] != spots(scenario)[label][0]:
        raise Conflict(f"{cup} has not been seen at {label}")
    x, y, phi = mapped_cup(belief, cup)
    return Spot(table, x, y), phi


def stand_ranges(spot: Spot) -> Ranges:
    """Ranges of x, y and phi where the robot may stand for a spot; the map's axes are along the table's, or nearly."""
    phi = spot.table[2]
    nearest, farthest = (spot.from_edge_m + d for d in (TABLE_M[0] + TILT_M, TABLE_M[1] - TILT_M))
    farthest = max(nearest, min(farthest, REACH_M))
    along, across, sign = (
        ("x", "y", math.cos(phi)) if abs(math.cos(phi)) > abs(math.sin(phi)) else ("y", "x", math.sin(phi))
    )
    at, beside = (spot.x, spot.y) if along == "x" else (spot.y, spot.x)
    ends = sorted(at + math.copysign(d, sign) for d in (nearest, farthest))
    facing = wrap(phi + math.pi)
    return {
        along: Interval(*ends),
        across: Interval(beside - LATERAL_M, beside + LATERAL_M),
        "phi": Interval(facing - FACING_RAD, facing + FACING_RAD),
        "v": Interval(0.0, 0.0),
    }


def put_ranges(spot: Spot) -> Ranges:
    """Ranges of the position where a cup may be put at a spot."""
    phi = spot.table[2]
    along, across = SPOT_M if abs(math.cos(phi)) > abs(math.sin(phi)) else SPOT_M[::-1]
    return {
        "spot_x": Interval(spot.x - along, spot.x + along),
        "spot_y": Interval(spot.y - across, spot.y + across),
    }


def stands_before(belief: KitchenBelief, spot: Spot) -> bool:
    """Whether the robot stands where its arm reaches a spot."""
    ranges, pose = stand_ranges(spot), belief.pose
    in_x, in_y = (
        ranges[name].lower - SLACK_M <= value <= ranges[name].upper + SLACK_M
        for name, value in (("x", pose.x), ("y", pose.y))
    )
    middle = 0.5 * (ranges["phi"].lower + ranges["phi"].upper)
    return in_x and in_y and abs(difference(pose.phi, middle)) < FACING_RAD + SLACK_RAD


def place_of(belief: KitchenBelief, scenario: Scenario, cup: Thing) -> str | None:
    """Label of the place at which a cup stands upright: the nearest one of its table. None: at none.

    Before its table is seen, a cup near it stands on it, and at the place that the map gives it.
    """
    if cup.tilt > kitchen().cup.tipped_rad or not _is_high(cup):
        return None
    near = []
    for label, (name, _) in spots(scenario).items():
        unseen = belief.thing(name) is None
        if _on_top(cup, table_place(belief, name), UNSEEN_M if unseen else 0.0):
            if unseen and label == mapped_label(scenario, cup.name):
                return label
            spot = spot_of(belief, scenario, label)
            near.append((math.hypot(cup.x - spot.x, cup.y - spot.y), label))
    return min(near)[1] if near else None


def blocked(belief: KitchenBelief, scenario: Scenario, known: Collection[str]) -> set[str]:
    """Places whose spots are taken by a cup, upright or not, that is none of the known ones, but is seen there."""
    cups = [cup for cup in objects.cups(belief.things) if cup.name not in known and _is_high(cup)]
    spots_by_label = {label: spot_of(belief, scenario, label) for label in spots(scenario)} if cups else {}
    return {
        label
        for label, spot in spots_by_label.items()
        if any(math.hypot(cup.x - spot.x, cup.y - spot.y) < BLOCKED_M for cup in cups)
    }


def _is_high(cup: Thing) -> bool:
    """Whether it is as high as one on a table; one that lies there is a little lower."""
    return abs(cup.z - kitchen().table.size[2] - kitchen().cup.height / 2) <= ON_TOP_M


def _on_top(cup: Thing, table: Place, beside_m: float) -> bool:
    c, s = math.cos(table[2]), math.sin(table[2])
    dx, dy = cup.x - table[0], cup.y - table[1]
    deep, wide, _ = kitchen().table.size
    return abs(c * dx + s * dy) < deep / 2 + beside_m and abs(c * dy - s * dx) < wide / 2 + beside_m
