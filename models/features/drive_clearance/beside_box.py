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
from tailor.models.features.planar import POSE

MOST_M, LEAST_M = 1.0, -0.4  # clearances beyond these make no difference
# place and direction in the map, half length along that direction, half width, margin around, height
BOX = quantities("box_x:m box_y:m box_phi:rad box_long:m box_wide:m box_r:m box_high:m")
# the turn to the way, the angle of the bend or turn into the goal, the radius of that bend
DRIVE = quantities("v:m/s dist:m turn:rad bend:rad radius:m")
# of the base at the start, as it turns, drives straight, bends or turns into the goal, and there; of the hand likewise
CLEAR = quantities("clear:m clear_turn:m clear_straight:m clear_bend:m clear_g:m hand_turn:m hand_bend:m hand_g:m")
BASES, HANDS = 4 * POSES + 1, 3 * POSES + 1  # places of the base and of each disc of the hand
PARTS = 7  # four of the base, three of the hand
DISCS = [list(range(BASES + k * HANDS, BASES + (k + 1) * HANDS)) for k in range(2)]
PHI, PHIG, BOX_X, BOX_PHI, LONG, WIDE, MARGIN, HIGH = 2, 6, 8, 10, 11, 12, 13, 14


def beside_box(name: str, robot: DrivingRobot) -> FeatureSpace:
    """The feature space of a robot's drives beside one object."""
    return FeatureSpace(name, (*POSE, *BOX), (*DRIVE, *CLEAR), partial(_features, robot))


def _features(robot: DrivingRobot, rows: Rows, ops: Operations) -> Rows:
    poses, goal = _seen_from_box(rows, ops)
    planned = drive(robot, poses, goal, ops)
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
    places = [(turning.x, turning.y), (other.x, other.y), planned.straight, (arriving.x, arriving.y), (goal.x, goal.y)]
    places += [part.ahead(distance_m) for distance_m in robot.hand_m for part in (turning, other, arriving, goal)]
    distance = _distance(ops.stack(*(x for x, _ in places)), ops.stack(*(y for _, y in places)), rows, ops)
    base = distance[list(range(BASES))] - robot.base_m
    hand = _lower(distance[DISCS[0]], distance[DISCS[1]], ops) - robot.hand_radius_m
    hand = ops.where(rows[[HIGH]] < robot.hand_bottom_m, hand * 0.0 + MOST_M, hand)
    parts = _least_of_parts(ops.stack(base[list(range(BASES - 1))], hand[list(range(HANDS - 1))]), ops)
    turns = _lower(parts[[0, 4]], parts[[1, 5]], ops)
    bases = ops.stack(base[[0]], turns[[0]], parts[[2, 3]], base[[BASES - 1]])
    least = ops.stack(bases, turns[[1]], parts[[6]], hand[[HANDS - 1]])
    return ops.clip(least, LEAST_M, MOST_M)


def _least_of_parts(rows: Rows, ops: Operations) -> Rows:
    """Least of each part's POSES rows, shape (PARTS, n): halved until one is left."""
    for count in (POSES // 2, POSES // 4, POSES // 8):
        first = [k for k in range(PARTS * 2 * count) if k % (2 * count) < count]
        rows = _lower(rows[first], rows[[k + count for k in first]], ops)
    return rows


def _lower(first: Rows, second: Rows, ops: Operations) -> Rows:
    return ops.where(first < second, first, second)


def _seen_from_box(rows: Rows, ops: Operations) -> tuple[Rows, tuple[Rows, Rows]]:
    """Start and goal, each x, y, phi, in the frame of the rectangle; cosine and sine of the goal's heading there."""
    headings = rows[[PHI, PHIG]] - rows[[BOX_PHI]]
    cosine, sine = cosines(ops.stack(rows[[BOX_PHI]], headings[[1]]), ops)
    c, s = cosine[[0]], sine[[0]]
    dx, dy = rows[[0, 4]] - rows[[BOX_X]], rows[[1, 5]] - rows[[BOX_X + 1]]
    x, y = c * dx + s * dy, c * dy - s * dx
    poses = ops.stack(x, y, headings)
    return poses[[0, 2, 4, 1, 3, 5]], (cosine[[1]], sine[[1]])


def _distance(x: Rows, y: Rows, rows: Rows, ops: Operations) -> Rows:
    """Distances of places in the rectangle's frame from the object; negative inside."""
    dx, dy = ops.absolute(x) - rows[[LONG]], ops.absolute(y) - rows[[WIDE]]
    outside = length(ops.clip(dx, 0.0, LARGE), ops.clip(dy, 0.0, LARGE), ops)
    return outside + ops.clip(ops.where(dx < dy, dy, dx), -LARGE, 0.0) - rows[[MARGIN]]
