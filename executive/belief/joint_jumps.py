"""Joints that are found where they cannot have moved to: pushed, mounted anew, or measured from another zero."""

from __future__ import annotations

from collections.abc import Sequence

JUMP_RAD = 0.1  # six times the largest error of a prediction over a tick: 0.017 rad in the arm, 0.012 in the B21


def jumped(predicted: Sequence[float], measured: Sequence[float], passed_s: float, fastest_radps: float) -> bool:
    """Whether any joint is found elsewhere than it can have moved to.

    Args:
      predicted: Angles to which the last velocities have led, rad.
      measured: Angles of the new reading, rad.
      passed_s: Since the reading before; something may have stopped a joint at once, at full speed.
      fastest_radps: Limit of each joint's velocity.
    """
    most = fastest_radps * max(0.0, passed_s) + JUMP_RAD
    return any(abs(after - before) > most for before, after in zip(predicted, measured, strict=True))
