"""Feature space of success beside one upright box or cylinder: clearances of a drive as planned.

The object is a rectangle with a margin around it: a cylinder is its margin alone. Further objects are further rows (see
executive/interfaces/action_context.py).
"""

from __future__ import annotations

from functools import partial

from tailor.models.features.drive_clearance.driving_robot import DrivingRobot
from tailor.models.features.drive_clearance.poses import POSES, Drive, Poses, drive
from tailor.models.features.drive_clearance.way import LARGE, cosines
from tailor.models.features.features import FeatureSpace, Operations, Rows, length, quantities
from tailor.models.features.straight_drive import DRIVE, SEEN

MOST_M, LEAST_M = 1.0, -0.4  # clearances beyond these make no difference
# place and direction in the map, half length along that direction, half width, margin around, height
BOX = quantities("box_x:m box_y:m box_phi:rad box_long:m box_wide:m box_r:m box_high:m")
# the turn to the way, the angle of the bend or turn into the goal, the radius of that bend
WAY = quantities("v:m/s dist:m turn:rad bend:rad radius:m")
# of the base at the start, as it turns, drives straight, bends or turns into the goal, and there; of the hand likewise
CLEAR = quantities("clear:m clear_turn:m clear_straight:m clear_bend:m clear_g:m hand_turn:m hand_bend:m hand_g:m")
PHI, PHIG, BOX_X, BOX_PHI, LONG, WIDE, MARGIN, HIGH = 2, 6, 9, 11, 12, 13, 14, 15


def beside_box(name: str, robot: DrivingRobot) -> FeatureSpace:
    """The feature space of a robot's drives beside one object."""
    return FeatureSpace(name, (*DRIVE, *BOX), (*WAY, *CLEAR), partial(_features, robot))


def _features(robot: DrivingRobot, rows: Rows, ops: Operations) -> Rows:
    poses, goal = _seen_from_box(rows, ops)
    planned = drive(robot, poses, rows[[3]], goal, rows[[SEEN]], ops)
    away = poses[[3, 4]] - poses[[0, 1]]
    return ops.stack(
        rows[[3]],
        length(away[[0]], away[[1]], ops),
        ops.absolute(planned.first.turn),
        planned.way.bend,
        planned.way.radius,
        _clearances(robot, planned, Poses(poses[[3]], poses[[4]], *goal), rows, ops),
    )


def _clearances(robot: DrivingRobot, planned: Drive, goal: Poses, rows: Rows, ops: Operations) -> Rows:
    """Clearances of base and hand; see CLEAR."""
    turning, other, arriving = planned.turning, planned.other, planned.arriving
    ways = [(turning.x, turning.y), (other.x, other.y), planned.straight, (arriving.x, arriving.y)]
    ways += [part.ahead(distance_m) for distance_m in robot.hand_m for part in (turning, other, arriving)]
    ends = [(turning.x[[0]], turning.y[[0]]), (goal.x, goal.y), *map(goal.ahead, robot.hand_m)]
    way, end = _least_distances(ways, POSES, rows, ops), _least_distances(ends, 1, rows, ops)
    base = ops.stack(end[[0]], ops.lower(way[[0]], way[[1]]), way[[2, 3]], end[[1]]) - robot.base_m
    hand = ops.lower(ops.stack(way[[4, 5, 6]], end[[2]]), ops.stack(way[[7, 8, 9]], end[[3]])) - robot.hand_radius_m
    hand = ops.stack(ops.lower(hand[[0]], hand[[1]]), hand[[2, 3]])
    hand = ops.where(rows[[HIGH]] < robot.hand_bottom_m, hand * 0.0 + MOST_M, hand)
    return ops.clip(ops.stack(base, hand), LEAST_M, MOST_M)


def _least_distances(parts: list[tuple[Rows, Rows]], size: int, rows: Rows, ops: Operations) -> Rows:
    """Least distance of each part's places from the object, negative inside.

    Args:
      parts: x and y of places in the rectangle's frame, each of shape (size, n).
      size: Number of places of each part.
      rows: The arguments.
      ops: Operations of features.
    """
    x, y = ops.stack(*(x for x, _ in parts)), ops.stack(*(y for _, y in parts))
    dx, dy = ops.absolute(x) - rows[[LONG]], ops.absolute(y) - rows[[WIDE]]
    ox, oy = ops.clip(dx, 0.0, LARGE), ops.clip(dy, 0.0, LARGE)
    outside, inside = ox * ox + oy * oy, ops.higher(dx, dy)
    if size > 1:  # roots and sums keep the order, so few are left to be computed
        outside, inside = ops.least(outside, len(parts), size), ops.least(inside, len(parts), size)
    return ops.sqrt(outside) + ops.clip(inside, -LARGE, 0.0) - rows[[MARGIN]]


def _seen_from_box(rows: Rows, ops: Operations) -> tuple[Rows, tuple[Rows, Rows]]:
    """Start and goal, each x, y, phi, in the frame of the rectangle; cosine and sine of the goal's heading there."""
    headings = rows[[PHI, PHIG]] - rows[[BOX_PHI]]
    cosine, sine = cosines(ops.stack(rows[[BOX_PHI]], headings[[1]]), ops)
    c, s = cosine[[0]], sine[[0]]
    dx, dy = rows[[0, 4]] - rows[[BOX_X]], rows[[1, 5]] - rows[[BOX_X + 1]]
    x, y = c * dx + s * dy, c * dy - s * dx
    poses = ops.stack(x, y, headings)
    return poses[[0, 2, 4, 1, 3, 5]], (cosine[[1]], sine[[1]])
