"""Opponents as the soccer robot believes them: standing obstacles on the field."""

from __future__ import annotations

import math
from dataclasses import dataclass
from heapq import nlargest, nsmallest
from typing import Any

import numpy as np

from tailor.executive.belief.obstacle_tracks import CONFIRMED, ObstacleTrack, Sighting, confirmed, in_map
from tailor.executive.belief.obstacle_tracks import see as see_obstacles
from tailor.executive.belief.planar_ekf import Pose
from tailor.executive.domains.soccer.pictures import Pictures, in_view, shown_after, with_picture
from tailor.executive.interfaces.values import Array
from tailor.schemas.messages.soccer import OpponentPercept, OpponentPercepts

MOST = 4  # of another team, that telemetry includes
KEPT = 24  # tracks, and percepts of a picture: more are no robots, and comparing all pairs takes time
FRESH_S = 0.5  # six pictures: without them the robot does not drive among opponents
CREDIBLE_M = 20.0  # a percept farther off is none
VARIANCES = (1e-6, 25.0)  # m²: a millimetre's, and that of 5 m; senders without a covariance send zeros
RADII_M = (0.05, 0.35)
NAMES = tuple(
    f"opponent{number}_{quantity} (m)" for number in range(1, MOST + 1) for quantity in ("x", "y", "radius", "sigma")
)


@dataclass(frozen=True, slots=True)
class Opponents:
    """Tracks in the map frame, when the last picture came (0 before the first), and the poses of pictures."""

    tracks: tuple[ObstacleTrack, ...] = ()
    seen_ns: int = 0
    pictures: Pictures = ()

    @property
    def standing(self) -> tuple[ObstacleTrack, ...]:
        """Those that were seen often enough to count."""
        return confirmed(self.tracks)


NONE = Opponents()


def see(opponents: Opponents, pose: Pose, now_ns: int, percepts: OpponentPercepts) -> Opponents:
    """Fuse a picture, taken from a pose."""

    def expected(track: ObstacleTrack) -> bool:
        return in_view((pose.x, pose.y, pose.phi), (track.x, track.y))

    near = [percept for percept in percepts.opponents if math.hypot(percept.x, percept.y) < CREDIBLE_M]
    if len(near) > KEPT:
        near = nsmallest(KEPT, near, key=lambda percept: math.hypot(percept.x, percept.y))
    sightings = [in_map(pose, _sighting(percept)) for percept in near]
    tracks = see_obstacles(opponents.tracks, sightings, now_ns, expected)
    if len(tracks) > KEPT:
        tracks = tuple(nlargest(KEPT, tracks, key=lambda track: (track.seen >= CONFIRMED, track.seen_ns)))
    return Opponents(tracks, now_ns, with_picture(opponents.pictures, pose))


def unseen(belief: Any, turn: float) -> bool:
    """Whether a turn by an angle (rad) leads where an opponent may stand that no picture has shown, of a SoccerBelief.

    Never before a picture was searched for opponents: nobody expects any.
    """
    known = belief.opponents
    return bool(known.seen_ns) and not shown_after(known.pictures, belief.pose, turn)


def fresh(opponents: Opponents, now_ns: int) -> bool:
    """Whether opponents have never been looked for, or a picture came lately."""
    return not opponents.seen_ns or now_ns - opponents.seen_ns <= FRESH_S * 1e9


def values(opponents: Opponents, padded: bool = False) -> tuple[float, ...]:
    """Values of NAMES, on an empty field only if `padded`; one that is not there has a standard deviation of -1."""
    if not (opponents.standing or padded):
        return ()
    shown = {track.number: (track.x, track.y, track.radius_m, track.sigma_m) for track in opponents.standing}
    return tuple(value for number in range(MOST) for value in shown.get(number, (0.0, 0.0, 0.0, -1.0)))


def rows(belief: Any) -> Array:
    """Centre and radius of each opponent (m, map frame), shape (m, 3), of a SoccerBelief."""
    standing = belief.opponents.standing
    return np.array([(t.x, t.y, t.radius_m) for t in standing], dtype=np.float64).reshape(-1, 3)


def _sighting(seen: OpponentPercept) -> Sighting:
    """The percept with a valid covariance matrix, whatever was received."""
    var_x, var_y = _within(seen.var_x, VARIANCES), _within(seen.var_y, VARIANCES)
    limit = 0.99 * math.sqrt(var_x * var_y)
    return Sighting(
        seen.x, seen.y, var_x, var_y, _within(seen.cov_xy, (-limit, limit)), _within(seen.radius_m, RADII_M)
    )


def _within(value: float, limits: tuple[float, float]) -> float:
    return min(limits[1], max(limits[0], value))
