"""Pictures that are no measurements: they show furniture of the kitchen where, or as, it cannot be.

A table that is believed where it does not stand leads the base against the true one. Whether the camera errs, the
detector, the localisation or the map: the robot does not drive by it. The stool may stand anywhere; people move it.
"""

from __future__ import annotations

import math

from tailor.executive.domains.kitchen.belief import KitchenBelief, ready
from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.messages import Message
from tailor.schemas.messages.kitchen import ObjectPercept, ObjectPercepts

MAX_TURN_RAD = math.tau  # of a direction or a tilt, in whatever range a detector counts them
MAX_CUP_M = 3.0  # height or depth of a cup: a hand lifts it to 1.2 m
TOP_M = 0.3  # by which the top of furniture may be misjudged: ten times the noise at 5 m
LEAN_RAD = 0.5  # beyond it furniture has fallen, and stands on another outline than all clearances count with
FAR_M = 20.0  # more than twice the kitchen's diagonal
TABLE_M = 1.0  # of a table from its place on the map: six times the displacement that it is drawn with


def fault(belief: KitchenBelief, message: Message) -> str:
    """Why a message is no measurement, e.g. "has table1 at a height of 3 m"; empty if it is one."""
    if not isinstance(message, ObjectPercepts):
        return ""
    return next((f"has {each.name} {found}" for each in message.objects if (found := _fault(belief, each))), "")


def _fault(belief: KitchenBelief, percept: ObjectPercept) -> str:
    is_cup, is_table = percept.name in kitchen().cups, percept.name in kitchen().tables
    if not is_cup and not is_table and percept.name != "stool":
        return ""  # a detector finds other things too
    if (away_m := math.hypot(percept.x, percept.y)) > FAR_M:
        return f"{away_m:g} m away"
    if abs(percept.phi) > MAX_TURN_RAD:
        return f"turned by {percept.phi:g} rad"
    if abs(percept.tilt) > (MAX_TURN_RAD if is_cup else LEAN_RAD):
        return f"tilted by {percept.tilt:g} rad"
    top_m, off_m = (0.0, MAX_CUP_M) if is_cup else (_top_m(is_table), TOP_M)
    if abs(percept.z - top_m) > off_m:
        return f"at a height of {percept.z:g} m"
    off_m = _off_map_m(belief, percept) if is_table and ready(belief) else 0.0
    return f"{off_m:.1f} m from its place on the map" if off_m > TABLE_M else ""


def _top_m(is_table: bool) -> float:
    return kitchen().table.size[2] if is_table else kitchen().stool.height


def _off_map_m(belief: KitchenBelief, percept: ObjectPercept) -> float:
    mapped_x, mapped_y, _ = kitchen().tables[percept.name]
    ahead, left = belief.in_base(mapped_x, mapped_y)
    return math.hypot(percept.x - ahead, percept.y - left)
