"""Feature space of success beside one obstacle, for robots that drive on a plane: Table 7's, and where the obstacle is.

The obstacle is a disc; further obstacles are further rows (see executive/interfaces/action_context.py).
"""

from __future__ import annotations

from tailor.models.features.features import (
    SAME_PLACE,
    FeatureSpace,
    Operations,
    Rows,
    direction,
    length,
    quantities,
    wrap,
)
from tailor.models.features.planar import POSE, TOWARD, sighted
from tailor.models.features.planar import SPACES as PLANAR

OBSTACLE = quantities("obstacle_x:m obstacle_y:m obstacle_r:m")
# along the line of sight from the start, across it (positive on the side to which the robot turns first), clearance of
# the line between start and goal, of start and goal; angle from the robot's heading to the obstacle at start and goal
BESIDE = quantities("along:m across:m clear_way:m clear:m clear_g:m angle_to_obstacle:rad angle_to_obstacle_g:rad")


def _one_obstacle(rows: Rows, ops: Operations) -> Rows:
    away, dist, turns, left = sighted(rows, ops)
    place, radius = rows[[8, 9]], rows[[10]]
    offset, offset_g = place - rows[[0, 1]], place - rows[[4, 5]]
    along, across = _on_sight(away, dist, offset, ops)
    beyond = ops.where(along < 0.0, along, ops.where(along < dist, 0.0, along - dist))
    clear_way = length(beyond, across, ops) - radius
    clear, angle = _polar(offset, rows[[2]], ops)
    clear_g, angle_g = _polar(offset_g, rows[[6]], ops)
    return ops.stack(
        rows[[3, 7]],
        dist,
        ops.absolute(turns[[0]]),
        turns[[1]] * left,
        along,
        across * left,
        clear_way,
        clear - radius,
        clear_g - radius,
        angle,
        angle_g,
    )


def _on_sight(away: Rows, dist: Rows, offset: Rows, ops: Operations) -> tuple[Rows, Rows]:
    """Coordinates of the obstacle along and across the line of sight; at zero distance the sight is the x axis."""
    dx, dy, ox, oy = away[[0]], away[[1]], offset[[0]], offset[[1]]
    inverse = 1.0 / dist
    along, across = (ox * dx + oy * dy) * inverse, (oy * dx - ox * dy) * inverse
    same = dist < SAME_PLACE
    return ops.where(same, ox, along), ops.where(same, oy, across)


def _polar(offset: Rows, phi: Rows, ops: Operations) -> tuple[Rows, Rows]:
    """Distance of the obstacle, and its unsigned angle from a heading."""
    away = length(offset[[0]], offset[[1]], ops)
    angle = wrap(direction(offset[[0]], offset[[1]], away, phi, ops) - phi, ops)
    return away, ops.absolute(angle)


one_obstacle = FeatureSpace("one-obstacle", (*POSE, *OBSTACLE), (*TOWARD, *BESIDE), _one_obstacle)
SPACES = (*PLANAR, one_obstacle)
