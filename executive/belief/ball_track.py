"""The believed ball: seen, rolling to a stop, or carried along in front of the robot.

Kept in the robot's frame, where it is seen and where the rail holds it; its velocity is over ground.
A ball that is not seen rolls on and its uncertainty grows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

VELOCITY_MEMORY = 0.8  # weight of the old velocity at a percept: steps of 80 ms, so about 0.4 s
SHORTEST_S = 0.02  # between two percepts; noise over less would be a fast ball
GROWTH_M2_PER_S = 4e-4  # a resting ball out of sight: 2 cm after 1 s
CARRIED_GROWTH_M2_PER_S = 1e-3  # a ball in the grip may slide in it
MOVING_GROWTH_M2_PER_S = 9e-3  # at 1 m/s; proportional to its speed
SURPRISING = 5.0  # standard deviations: with 12 percepts a second, four would come about every few minutes


@dataclass(frozen=True, slots=True)
class BallTrack:
    """Position in base_link (m, x ahead, y left), velocity over ground in the map frame (m/s)."""

    ahead: float
    left: float
    vx: float
    vy: float
    variance: float  # m², of either axis
    seen_ns: int  # when it was last seen


@dataclass(frozen=True, slots=True)
class Seen:
    """A percept of the ball: position in the robot's frame (m), with its covariance (m²)."""

    ahead: float
    left: float
    var_ahead: float
    var_left: float
    covariance: float


def move(track: BallTrack, v: float, turn: float, phi: float, duration_s: float, rolling_mps2: float) -> BallTrack:
    """Predict the track: the ball rolls and the robot drives for `duration_s`.

    Args:
      track: The ball before.
      v: The robot's speed, m/s.
      turn: The robot's turn during the step, rad.
      phi: The robot's heading in the middle of the step, map frame.
      duration_s: Seconds, >= 0.
      rolling_mps2: Deceleration of a rolling ball.
    """
    speed = math.hypot(track.vx, track.vy)
    kept = max(0.0, 1.0 - rolling_mps2 * duration_s / speed) if speed > 0.0 else 0.0
    mean = 0.5 * (1.0 + kept) * duration_s
    c, s = math.cos(phi), math.sin(phi)
    ahead = track.ahead + (c * track.vx + s * track.vy) * mean - v * duration_s
    left = track.left + (c * track.vy - s * track.vx) * mean
    ct, st = math.cos(turn), math.sin(turn)
    growth = (GROWTH_M2_PER_S + MOVING_GROWTH_M2_PER_S * speed) * duration_s
    return BallTrack(
        ct * ahead + st * left,
        ct * left - st * ahead,
        track.vx * kept,
        track.vy * kept,
        track.variance + growth,
        track.seen_ns,
    )


def carry(track: BallTrack, v: float, omega: float, phi: float, duration_s: float) -> BallTrack:
    """A ball in the robot's grip: it stays where it is in the robot's frame and moves with it."""
    c, s = math.cos(phi), math.sin(phi)
    forward, sideways = v - omega * track.left, omega * track.ahead
    return BallTrack(
        track.ahead,
        track.left,
        c * forward - s * sideways,
        s * forward + c * sideways,
        track.variance + CARRIED_GROWTH_M2_PER_S * duration_s,
        track.seen_ns,
    )


def see(track: BallTrack | None, seen: Seen, phi: float, now_ns: int) -> BallTrack:
    """Fuse a percept; one far from the believed place starts a new track.

    Args:
      track: The ball before; None if it was never seen.
      seen: The percept.
      phi: The robot's heading, map frame.
      now_ns: Time of the percept.
    """
    ahead, left, variance = seen.ahead, seen.left, 0.5 * (seen.var_ahead + seen.var_left)
    if track is None or _surprising(track, seen):
        return BallTrack(ahead, left, 0.0, 0.0, variance, now_ns)
    gain = track.variance / (track.variance + variance)
    d_ahead, d_left = gain * (ahead - track.ahead), gain * (left - track.left)
    elapsed_s = 1e-9 * (now_ns - track.seen_ns)
    push = (1.0 - VELOCITY_MEMORY) / max(elapsed_s, SHORTEST_S) if elapsed_s > 0.0 else 0.0
    c, s = math.cos(phi), math.sin(phi)
    return BallTrack(
        track.ahead + d_ahead,
        track.left + d_left,
        track.vx + push * (c * d_ahead - s * d_left),
        track.vy + push * (s * d_ahead + c * d_left),
        track.variance * (1.0 - gain),
        now_ns,
    )


def _surprising(track: BallTrack, seen: Seen) -> bool:
    """Beyond five standard deviations (Mahalanobis), and 10 cm: somebody moved the ball.

    A camera errs along its line of sight more than across; held against the mean of both, half a metre of noise would
    move the ball now and then.
    """
    d_ahead, d_left = seen.ahead - track.ahead, seen.left - track.left
    a, b, c = seen.var_ahead + track.variance, seen.var_left + track.variance, seen.covariance
    determinant = a * b - c * c
    scaled = b * d_ahead * d_ahead - 2.0 * c * d_ahead * d_left + a * d_left * d_left  # distance² x determinant
    return scaled > SURPRISING**2 * determinant and d_ahead * d_ahead + d_left * d_left > 0.01
