"""The believed ball: seen, rolling to a stop, or carried along in front of the robot.

Kept in the robot's frame, where it is seen and where the rail holds it; its velocity is over ground.
A ball that is not seen rolls on and its uncertainty grows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

VELOCITY_MEMORY = 0.8  # weight of the old velocity at a percept: steps of 80 ms, so about 0.4 s
GROWTH_M2_PER_S = 4e-4  # a resting ball out of sight: 2 cm after 1 s
CARRIED_GROWTH_M2_PER_S = 1e-3  # a ball in the grip may slide in it
MOVING_GROWTH_M2_PER_S = 9e-3  # at 1 m/s; proportional to its speed
MOVED_PERCEPTS = 2  # so many far off in a row, and somebody moved the ball; a single one is an outlier


@dataclass(frozen=True, slots=True)
class BallTrack:
    """Position in base_link (m, x ahead, y left), velocity over ground in the map frame (m/s)."""

    ahead: float
    left: float
    vx: float
    vy: float
    variance: float  # m², of either axis
    seen_ns: int  # when it was last seen
    doubted: int = 0  # percepts in a row that were far off


def move(track: BallTrack, v: float, turn: float, phi: float, duration_s: float, rolling_mps2: float) -> BallTrack:
    """Let the ball roll and the robot drive under it for `duration_s`.

    Args:
      track: The ball before.
      v: The robot's speed, m/s.
      turn: How far the robot turns meanwhile, rad.
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
        track.doubted,
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
        track.doubted,
    )


def see(track: BallTrack | None, ahead: float, left: float, variance: float, phi: float, now_ns: int) -> BallTrack:
    """Fuse a percept (m, robot's frame, m² of either axis); a second one far off in a row starts a new track."""
    if track is None:
        return BallTrack(ahead, left, 0.0, 0.0, variance, now_ns)
    if _surprising(track, ahead, left, variance):
        doubted = track.doubted + 1
        if doubted < MOVED_PERCEPTS:
            return replace(track, doubted=doubted)
        return BallTrack(ahead, left, 0.0, 0.0, variance, now_ns)
    gain = track.variance / (track.variance + variance)
    d_ahead, d_left = gain * (ahead - track.ahead), gain * (left - track.left)
    elapsed_s = 1e-9 * (now_ns - track.seen_ns)
    push = (1.0 - VELOCITY_MEMORY) / elapsed_s if elapsed_s > 0.0 else 0.0
    c, s = math.cos(phi), math.sin(phi)
    return BallTrack(
        track.ahead + d_ahead,
        track.left + d_left,
        track.vx + push * (c * d_ahead - s * d_left),
        track.vy + push * (s * d_ahead + c * d_left),
        track.variance * (1.0 - gain),
        now_ns,
    )


def _surprising(track: BallTrack, ahead: float, left: float, variance: float) -> bool:
    """Beyond four standard deviations, and 10 cm."""
    off_squared = (ahead - track.ahead) ** 2 + (left - track.left) ** 2
    return off_squared > 16.0 * (track.variance + variance) and off_squared > 0.01
