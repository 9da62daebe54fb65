"""What the clearances of a planned drive depend on: the outline of a robot, and how its controller drives."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Drift:
    """How far a robot leaves the place where it turns to a far goal: as if its speed grew in proportion to the turn.

    Attributes:
      least: Least growth of the speed, m/s a radian.
      most: Largest growth.
      slope: By how much it grows for each radian that the turn is smaller than `from_rad`.
      from_rad: That turn.
    """

    least: float
    most: float
    slope: float
    from_rad: float


@dataclass(frozen=True, slots=True)
class DrivingRobot:
    """A round robot whose hand may reach over its front, and which drives to far goals by an `ArrivalPath`.

    Attributes:
      base_m: Radius of the base.
      hand_m: How far ahead of the base's middle two discs lie that cover the hand.
      hand_radius_m: Radius of these.
      hand_bottom_m: What is lower than this cannot touch the hand.
      v_max_mps: Maximum speed.
      bend_worth_radps: As in `ArrivalPath`.
      near_m: To nearer goals it turns, drives straight and turns.
      back_m: So it does to goals nearer than this, too, if it turns in all by less than `back_rad` as it backs off, and
        has seen what may stand behind it.
      back_rad: See `back_m`.
      there_m: To goals as near as this it only turns.
      drift: In turning to far goals.
      braking_mps2: With which it brakes straight ahead before it turns, where it begins in motion.
    """

    base_m: float
    hand_m: tuple[float, float]
    hand_radius_m: float
    hand_bottom_m: float
    v_max_mps: float
    bend_worth_radps: float
    near_m: float
    back_m: float
    back_rad: float
    there_m: float
    drift: Drift
    braking_mps2: float
