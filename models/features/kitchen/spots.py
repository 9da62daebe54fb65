"""Feature spaces of an arm on a base that reaches for spots on tables: the spot as seen from the base (Table 7)."""

from __future__ import annotations

from tailor.models.features.features import FeatureSpace, Operations, Rows, direction, length, quantities, wrap

SPOT = quantities("x:m y:m phi:rad spot_x:m spot_y:m aside:rad")
SEEN = quantities("dist:m angle_to:rad aside:rad turned:rad")


def _seen(rows: Rows, ops: Operations) -> Rows:
    """Distance of the spot, unsigned bearing from the robot's heading, and how the hand turns away from that."""
    dx, dy = rows[[3]] - rows[[0]], rows[[4]] - rows[[1]]
    dist = length(dx, dy, ops)
    bearing = wrap(direction(dx, dy, dist, rows[[2]], ops) - rows[[2]], ops)
    left = ops.where(bearing < 0.0, bearing * 0.0 - 1.0, bearing * 0.0 + 1.0)
    return ops.stack(dist, ops.absolute(bearing), ops.absolute(rows[[5]]), rows[[5]] * left)


def _reached(rows: Rows, ops: Operations) -> Rows:
    return ops.stack(_seen(rows, ops), rows[[6]])


def _handled(rows: Rows, ops: Operations) -> Rows:
    """Also how far the cup's handle is off the direction of the hand, on either side."""
    dx, dy = rows[[3]] - rows[[0]], rows[[4]] - rows[[1]]
    away = direction(dx, dy, length(dx, dy, ops), rows[[2]], ops) + rows[[5]]
    return ops.stack(_reached(rows, ops), ops.absolute(wrap(rows[[7]] - away, ops)))


SPOTS = (
    FeatureSpace("spot", SPOT, SEEN, _seen),
    FeatureSpace("spot-out", (*SPOT, *quantities("out:1")), (*SEEN, *quantities("out:1")), _reached),
    FeatureSpace(
        "spot-handle",
        (*SPOT, *quantities("out:1 handle:rad")),
        (*SEEN, *quantities("out:1 off_handle:rad")),
        _handled,
    ),
)
