"""Shortest paths of bounded curvature between two poses: arcs of one radius and straight lines.

Notation: a path is three pieces, each turning left (+1), right (-1) or straight (0). Lengths in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

Pose2 = tuple[float, float, float]  # x m, y m, heading rad
Piece = tuple[int, float]  # turn, length m
Pieces = tuple[Piece, Piece, Piece]
Centres = dict[int, tuple[float, float]]  # of a circle for each turn, m
SAME_M = 1e-9  # circles with centres so near to each other are one


@dataclass(frozen=True, slots=True)
class DubinsPath:
    """From `start` along three pieces of curvature turn/radius."""

    start: Pose2
    radius: float
    pieces: tuple[Piece, ...]
    _joints: tuple[Pose2, ...] = field(init=False, repr=False, compare=False)  # where pieces begin, and the end

    def __post_init__(self) -> None:
        """Work out once what every look-up needs."""
        joints = [self.start]
        for turn, length in self.pieces:
            joints.append(_along(joints[-1], turn, length, self.radius))
        object.__setattr__(self, "_joints", tuple(joints))

    @property
    def length(self) -> float:
        """Of all pieces, m."""
        return sum(length for _, length in self.pieces)

    def between(self, run_in_m: float, run_out_m: float) -> DubinsPath:
        """The same path with a straight run-in before its start and a straight run-out."""
        start = straight_on(self.start, -run_in_m)
        return DubinsPath(start, self.radius, ((0, run_in_m), *self.pieces, (0, run_out_m)))

    def at(self, s: float) -> tuple[float, float, float, float]:
        """Pose and curvature (1/m, left positive) after `s` metres; beyond the end it goes straight on."""
        for (turn, length), joint in zip(self.pieces, self._joints, strict=False):
            if s <= length:
                return (*_along(joint, turn, max(0.0, s), self.radius), turn / self.radius)
            s -= length
        return (*_along(self._joints[-1], 0, s, self.radius), 0.0)


def straight_on(pose: Pose2, distance_m: float) -> Pose2:
    """The pose so far ahead; behind, if negative."""
    x, y, heading = pose
    return x + distance_m * math.cos(heading), y + distance_m * math.sin(heading), heading


def shortest(start: Pose2, goal: Pose2, radius: float) -> DubinsPath:
    """The shortest path of curvature at most 1/radius from one pose to the other."""
    return DubinsPath(start, radius, shortest_pieces(start, goal, radius))


def shortest_pieces(start: Pose2, goal: Pose2, radius: float) -> Pieces:
    """The pieces of the shortest path: all that a comparison of many needs."""
    first, last = _centres(start, radius), _centres(goal, radius)
    best: Pieces | None = None
    best_length = math.inf
    for candidate in (
        *_with_straight(start[2], goal[2], first, last, radius),
        *_with_arcs(start[2], goal[2], first, last, radius),
    ):
        length = candidate[0][1] + candidate[1][1] + candidate[2][1]
        if length < best_length:
            best, best_length = candidate, length
    assert best is not None  # LSL and RSR exist for every pair of poses
    return best


def _along(pose: Pose2, turn: int, s: float, radius: float) -> Pose2:
    x, y, heading = pose
    if turn == 0:
        return straight_on(pose, s)
    new = heading + turn * s / radius
    return (
        x + turn * radius * (math.sin(new) - math.sin(heading)),
        y - turn * radius * (math.cos(new) - math.cos(heading)),
        new,
    )


def _centres(pose: Pose2, radius: float) -> Centres:
    """Of the circles that a turn to the left and one to the right follow from this pose."""
    x, y, heading = pose
    across, along = radius * math.sin(heading), radius * math.cos(heading)
    return {1: (x - across, y + along), -1: (x + across, y - along)}


def _arc(turn: int, start: float, end: float, radius: float) -> Piece:
    """From heading to heading; a turn within rounding of a full circle is none."""
    angle = (turn * (end - start)) % math.tau
    return turn, radius * (angle if angle < math.tau - 1e-9 else 0.0)


def _with_straight(leave: float, arrive: float, firsts: Centres, lasts: Centres, radius: float) -> list[Pieces]:
    """LSL, RSR, LSR, RSL: the line touches the first and the last circle."""
    found: list[Pieces] = []
    for first, last in ((1, 1), (-1, -1), (1, -1), (-1, 1)):
        (ax, ay), (bx, by) = firsts[first], lasts[last]
        distance = math.hypot(bx - ax, by - ay)
        direction = math.atan2(by - ay, bx - ax) if distance > SAME_M else leave
        heading, straight = direction, distance
        if first != last:
            if distance < 2 * radius:
                continue
            straight = math.sqrt(distance * distance - 4 * radius * radius)
            heading = direction + first * math.atan2(2 * radius, straight)
        found.append((_arc(first, leave, heading, radius), (0, straight), _arc(last, heading, arrive, radius)))
    return found


def _with_arcs(leave: float, arrive: float, firsts: Centres, lasts: Centres, radius: float) -> list[Pieces]:
    """LRL, RLR: the middle circle touches both others."""
    found: list[Pieces] = []
    for turn in (1, -1):
        (ax, ay), (bx, by) = firsts[turn], lasts[turn]
        distance, direction = math.hypot(bx - ax, by - ay), math.atan2(by - ay, bx - ax)
        if distance > 4 * radius:
            continue
        aside = math.acos(distance / (4 * radius))
        for side in (1, -1):
            # from centre to centre: direction ± aside, then the mirrored way; headings are square to that
            into = direction + side * aside + turn * math.pi / 2
            out = direction - side * aside - turn * math.pi / 2
            middle = _arc(-turn, into, out, radius)
            found.append((_arc(turn, leave, into, radius), middle, _arc(turn, out, arrive, radius)))
    return found
