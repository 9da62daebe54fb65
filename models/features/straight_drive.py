"""Feature space of a robot that drives straight to near goals: `projective`, and whether it does so.

To goals that are near, or a little farther behind it where it has seen what may stand there, it turns, drives straight
and turns; into others it bends, as `executive/domains/kitchen/drive_to_stand.py` does. Durations jump between both by
seconds, where no model is steep enough.
"""

from __future__ import annotations

from tailor.models.features.features import TWO_PI, FeatureSpace, Operations, Rows, quantities
from tailor.models.features.planar import POSE, projective

NEAR_M = 1.0  # it drives straight to nearer goals,
BACK_M = 2.0  # and to those nearer than this to which it backs off
BACK_RAD = 2.2  # as it turns by less than this in all
SEEN = 8  # argument: 1 where the robot has seen what may stand behind it, else 0, and then it bends
DRIVE = (*POSE, *quantities("seen:1"))


def _straight_drive(rows: Rows, ops: Operations) -> Rows:
    seen = projective.rows(rows, ops)
    dist, to, at = seen[[2]], seen[[3]], seen[[4]]
    turning = (to + ops.absolute(at)) * -1.0 + TWO_PI  # as it backs off
    back_m = ops.where(rows[[SEEN]] < 0.5, dist * 0.0 + NEAR_M, dist * 0.0 + BACK_M)
    straight = dist < ops.where(turning < BACK_RAD, back_m, dist * 0.0 + NEAR_M)
    return ops.stack(seen, ops.where(straight, dist * 0.0 + 1.0, dist * 0.0))


straight_drive = FeatureSpace(
    "straight-drive", DRIVE, (*projective.features, *quantities("straight:1")), _straight_drive
)
