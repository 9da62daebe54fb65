"""Whether a robot drives straight to its goal, on intervals of what it sees; see `straight_drive.py`."""

from __future__ import annotations

import numpy as np

from tailor.models.features.intervals import ANGLE_ERROR, ARGUMENT_ERROR, TURN, Span, magnitude
from tailor.models.features.sight_intervals import Bools
from tailor.models.features.straight_drive import BACK_M, BACK_RAD, NEAR_M

SURE_RAD = 8 * ANGLE_ERROR  # sums of angles in single precision
SURE_M = 2 * ARGUMENT_ERROR
STRAIGHT, BENT = (Span(np.full((1, 1, 1), one), np.full((1, 1, 1), one)) for one in (1.0, 0.0))


def straight_or_bent(dist: Span, to: Span, at: Span, seen: Span) -> tuple[tuple[Span, Bools], tuple[Span, Bools]]:
    """The feature `straight`, and where it may have that value: 1, then 0.

    Args:
      dist: Distance of the goal.
      to: Unsigned angle to it.
      at: Angle at the goal.
      seen: See SEEN there.
    """
    aside = magnitude(at)
    least, most = TURN - to.upper - aside.upper - SURE_RAD, TURN - to.lower - aside.lower + SURE_RAD
    farthest = np.where((least < BACK_RAD) & (seen.upper >= 0.5), BACK_M, NEAR_M)
    surely = np.where((most < BACK_RAD) & (seen.lower >= 0.5), BACK_M, NEAR_M)
    may = np.asarray(dist.lower < farthest + SURE_M)
    must = np.asarray(dist.upper < surely - SURE_M)
    return (STRAIGHT, may), (BENT, ~must)
