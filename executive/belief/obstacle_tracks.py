"""Tracks of standing obstacles, round on the floor: association, fusion, and doubt about those that are not seen again.

Kept in the map frame, with the uncertainty of the robot's pose: the obstacles stand, the robot moves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from tailor.executive.belief.planar_ekf import Pose

GATE = 5.0  # standard deviations within which a percept belongs to a track; four of a million are farther off
DRIFT_M2_PER_S = 4e-4  # errors of the robot's pose last: percepts of a second are less worth than their number
CONFIRMED = 2  # percepts after which an obstacle counts
DOUBTED = 8  # pictures in a row without an obstacle that they should show: it is gone


@dataclass(frozen=True, slots=True)
class ObstacleTrack:
    """Centre with its covariance (m, m²; map frame) and radius of one obstacle."""

    number: int  # stays with the obstacle; smallest that is free at first
    x: float
    y: float
    var_x: float
    var_y: float
    cov_xy: float
    radius_m: float
    seen: int  # percepts fused
    seen_ns: int  # the last one
    missed: int = 0  # pictures in a row that should have shown it

    @property
    def sigma_m(self) -> float:
        """Standard deviation of the centre, mean of both axes."""
        return math.sqrt(0.5 * (self.var_x + self.var_y))


@dataclass(frozen=True, slots=True)
class Sighting:
    """One percept: centre with covariance and radius (m, m²)."""

    x: float
    y: float
    var_x: float
    var_y: float
    cov_xy: float
    radius_m: float


def in_map(pose: Pose, seen: Sighting) -> Sighting:
    """A percept in the robot's frame, moved to the map frame; its covariance includes the pose's."""
    c, s = math.cos(pose.phi), math.sin(pose.phi)
    dx, dy = c * seen.x - s * seen.y, s * seen.x + c * seen.y
    xx, xy, _, yy, _, turn = pose.covariance
    var_x = c * c * seen.var_x - 2 * c * s * seen.cov_xy + s * s * seen.var_y
    var_y = s * s * seen.var_x + 2 * c * s * seen.cov_xy + c * c * seen.var_y
    cov_xy = c * s * (seen.var_x - seen.var_y) + (c * c - s * s) * seen.cov_xy
    x, y = pose.x + dx, pose.y + dy
    return Sighting(
        x, y, var_x + xx + turn * dy * dy, var_y + yy + turn * dx * dx, cov_xy + xy - turn * dx * dy, seen.radius_m
    )


def see(
    tracks: Sequence[ObstacleTrack],
    sightings: Sequence[Sighting],
    now_ns: int,
    in_view: Callable[[ObstacleTrack], bool],
) -> tuple[ObstacleTrack, ...]:
    """Fuse all percepts of one picture.

    Args:
      tracks: Obstacles before.
      sightings: Percepts, map frame.
      now_ns: Time of the picture.
      in_view: Whether a picture of now shows an obstacle there for certain, unless it is overlooked.
    """
    pairs = sorted(
        (distance, i, j)
        for i, track in enumerate(tracks)
        for j, sighting in enumerate(sightings)
        if (distance := _distance(track, sighting)) is not None
    )
    matched: dict[int, int] = {}
    for _, i, j in pairs:
        if i not in matched and j not in matched.values():
            matched[i] = j
    kept = [
        _fused(track, sightings[matched[i]], now_ns) if i in matched else _missed(track, in_view(track))
        for i, track in enumerate(tracks)
    ]
    kept = [track for track in kept if track.missed < DOUBTED]
    for j, sighting in enumerate(sightings):
        if j not in matched.values():
            kept.append(_begun(sighting, now_ns, {track.number for track in kept}))
    return tuple(kept)


def confirmed(tracks: Sequence[ObstacleTrack]) -> tuple[ObstacleTrack, ...]:
    """Those that were seen often enough to count."""
    return tuple(track for track in tracks if track.seen >= CONFIRMED)


def _distance(track: ObstacleTrack, sighting: Sighting) -> float | None:
    """Mahalanobis distance; None for another obstacle. Two cannot overlap: nearer than a radius, it is the same one."""
    dx, dy = sighting.x - track.x, sighting.y - track.y
    a, b, c = track.var_x + sighting.var_x, track.var_y + sighting.var_y, track.cov_xy + sighting.cov_xy
    distance = math.sqrt(max(0.0, (b * dx * dx - 2.0 * c * dx * dy + a * dy * dy) / (a * b - c * c)))
    overlaps = math.hypot(dx, dy) < track.radius_m
    return distance if distance < GATE or overlaps else None


def _fused(track: ObstacleTrack, seen: Sighting, now_ns: int) -> ObstacleTrack:
    """Kalman filter for a place that does not move."""
    growth = DRIFT_M2_PER_S * 1e-9 * max(0, now_ns - track.seen_ns)
    xx, yy, xy = track.var_x + growth, track.var_y + growth, track.cov_xy
    a, b, c = xx + seen.var_x, yy + seen.var_y, xy + seen.cov_xy
    scale = 1.0 / (a * b - c * c)
    k11, k12 = (xx * b - xy * c) * scale, (xy * a - xx * c) * scale
    k21, k22 = (xy * b - yy * c) * scale, (yy * a - xy * c) * scale
    dx, dy = seen.x - track.x, seen.y - track.y
    count = track.seen + 1
    return ObstacleTrack(
        track.number,
        track.x + k11 * dx + k12 * dy,
        track.y + k21 * dx + k22 * dy,
        xx - k11 * xx - k12 * xy,
        yy - k21 * xy - k22 * yy,
        xy - k11 * xy - k12 * yy,
        track.radius_m + (seen.radius_m - track.radius_m) / count,
        count,
        now_ns,
    )


def _missed(track: ObstacleTrack, expected: bool) -> ObstacleTrack:
    return replace(track, missed=track.missed + 1) if expected else track


def _begun(seen: Sighting, now_ns: int, taken: set[int]) -> ObstacleTrack:
    number = next(number for number in range(len(taken) + 1) if number not in taken)
    return ObstacleTrack(number, seen.x, seen.y, seen.var_x, seen.var_y, seen.cov_xy, seen.radius_m, 1, now_ns)
