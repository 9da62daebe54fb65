"""What stands beside the kitchen robot's drives: stool, tables, fixed furniture and walls, as upright boxes."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from tailor.executive.actions.planar import PHIG, XG, YG, V, X, Y
from tailor.executive.domains.kitchen.belief import KitchenBelief
from tailor.executive.domains.kitchen.known_places import stool_place, table_place
from tailor.executive.interfaces.action_context import ActionContext, ContextColumn
from tailor.executive.interfaces.values import Array
from tailor.schemas.kitchen.furniture import Place, Size, kitchen
from tailor.schemas.kitchen.kinematics import BASE_RADIUS_M

Row = tuple[float, ...]
MOVED_M, TURNED_RAD = 0.07, 0.2  # when an object turns out to stand elsewhere by this, the way is decided anew
STOOL_RADII_M = (0.15, 0.29)
UNSEEN_M = 0.10  # by which a stool that has not been seen counts as wider: the map may be wrong by twice as much
TURN_RAD = -math.pi / 4  # a box looks the same after half a turn: from here on directions are counted
TOUCHED = "touched furniture"
HAND_BOTTOM_M, HAND_REACH_M = 1.03, 0.61  # of the folded arm: what is lower is met by the base alone
BEND_M, RUN_IN_M = 0.45, 0.10  # radius of the bend into a far goal, and the straight piece after it
DRIFT_M = 0.3  # most by which a robot leaves the place where it turns to a far goal
STRAIGHT_M = 1.0  # nearer goals are driven to straight, others perhaps
SURE_M = 0.15  # beyond that from such a rectangle, drives met none of 6400 objects that they touched
TOUCH_COST_S = 30.0  # a base that has driven against something mostly stays there until the action runs out of time


def furniture_rows(belief: KitchenBelief) -> Array:
    """Place, direction, half sizes, margin and height of each piece, shape (m, 7); m, rad, map frame."""
    stool, table = kitchen().stool, kitchen().table.size
    radius = stool.radius if belief.thing("stool") is not None else stool.radius + UNSEEN_M
    rows = [(*stool_place(belief), 0.0, 0.0, 0.0, radius, stool.height), *_fixed_rows()]
    rows += [_box(table_place(belief, name), table) for name in kitchen().tables]
    return np.array(rows)


@cache
def _fixed_rows() -> tuple[Row, ...]:
    """Furniture that never moves, and the walls."""
    (west, east), (south, north), thick = kitchen().x, kitchen().y, kitchen().wall_thickness
    middle, width, depth = ((west + east) / 2, (south + north) / 2), east - west + 2 * thick, north - south
    across, along = (depth, thick, kitchen().wall_height), (width, thick, kitchen().wall_height)
    walls = [((x, middle[1], math.pi / 2), across) for x in (west - thick / 2, east + thick / 2)]
    walls += [((middle[0], y, 0.0), along) for y in (south - thick / 2, north + thick / 2)]
    return tuple(_box(*each) for each in (*((one.place, one.size) for one in kitchen().fixed.values()), *walls))


def _box(place: Place, size: Size) -> Row:
    x, y, phi = place
    return (x, y, (phi - TURN_RAD) % math.pi + TURN_RAD, size[0] / 2, size[1] / 2, 0.0, size[2])


def may_meet(arguments: Array, rows: Array) -> Array:
    """Whether a drive may come near each piece, shape (m, n): by a rectangle around all that it may pass.

    A straight drive stays between its ends. A far one, perhaps begun before, ends with a bend on either side of its
    goal, and leaves the place where it turns before it faces its way.
    """
    x, y, phi, long, wide, margin, high = rows[:, :, None].transpose(1, 0, 2)
    distance = np.hypot(arguments[:, XG] - arguments[:, X], arguments[:, YG] - arguments[:, Y])
    far = (distance >= STRAIGHT_M) | (arguments[:, V] > 0.0)
    behind, around = np.where(far, RUN_IN_M, 0.0), np.where(far, BEND_M, 0.0)
    c, s = np.cos(phi), np.sin(phi)
    gap = []
    for a, b, half in ((c, s, long), (-s, c, wide)):
        start = a * (arguments[:, X] - x) + b * (arguments[:, Y] - y)
        goal = a * (arguments[:, XG] - x) + b * (arguments[:, YG] - y)
        ahead = a * np.cos(arguments[:, PHIG]) + b * np.sin(arguments[:, PHIG])
        centre, aside = goal - ahead * behind, np.sqrt(np.maximum(0.0, 1.0 - ahead**2)) * around
        lowest = np.minimum(start - DRIFT_M * far, np.minimum(goal, centre - aside - around))
        highest = np.maximum(start + DRIFT_M * far, np.maximum(goal, centre + aside + around))
        gap.append(np.maximum(0.0, np.maximum(lowest, -highest) - half))
    reach = margin + np.where(high > HAND_BOTTOM_M, HAND_REACH_M, BASE_RADIUS_M) + SURE_M
    near: Array = np.hypot(*gap) < reach
    return near


# goToPose ignores what stands in its way
FURNITURE = ActionContext(
    (
        ContextColumn("box_x", "m", *kitchen().x, MOVED_M),
        ContextColumn("box_y", "m", *kitchen().y, MOVED_M),
        ContextColumn("box_phi", "rad", TURN_RAD, TURN_RAD + math.pi, TURNED_RAD),
        ContextColumn("box_long", "m", 0.0, 3.2),
        ContextColumn("box_wide", "m", 0.0, 0.55),
        ContextColumn("box_r", "m", 0.0, STOOL_RADII_M[1]),
        ContextColumn("box_high", "m", 0.45, 2.0),
    ),
    furniture_rows,
    "goToPose/clearance",
    TOUCHED,
    TOUCH_COST_S,
    may_meet,
)
