"""Shortest paths of bounded curvature between two poses: arcs of one radius and straight lines.

Notation: a path is three pieces, each turning left (+1), right (-1) or straight (0). Lengths in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

Pose2 = tuple[float, float, float]  # x m, y m, heading rad
Piece = tuple[int, float]  # turn, length m
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
    best: tuple[Piece, Piece, Piece] | None = None
    best_length = math.inf
    for candidate in (*_with_straight(start, goal, radius), *_with_arcs(start, goal, radius)):
        length = candidate[0][1] + candidate[1][1] + candidate[2][1]
        if length < best_length:
            best, best_length = candidate, length
    assert best is not None  # LSL and RSR exist for every pair of poses
    return DubinsPath(start, radius, best)


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


def _centre(pose: Pose2, turn: int, radius: float) -> tuple[float, float]:
    """Of the circle that a turn from this pose follows."""
    x, y, heading = pose
    return x - turn * radius * math.sin(heading), y + turn * radius * math.cos(heading)


def _arc(turn: int, start: float, end: float, radius: float) -> Piece:
    """From heading to heading; a turn within rounding of a full circle is none."""
    angle = (turn * (end - start)) % math.tau
    return turn, radius * (angle if angle < math.tau - 1e-9 else 0.0)


def _with_straight(start: Pose2, goal: Pose2, radius: float) -> list[tuple[Piece, Piece, Piece]]:
    """LSL, RSR, LSR, RSL: the line touches the first and the last circle."""
    found = []
    for first, last in ((1, 1), (-1, -1), (1, -1), (-1, 1)):
        ax, ay = _centre(start, first, radius)
        bx, by = _centre(goal, last, radius)
        distance = math.hypot(bx - ax, by - ay)
        direction = math.atan2(by - ay, bx - ax) if distance > SAME_M else start[2]
        heading, straight = direction, distance
        if first != last:
            if distance < 2 * radius:
                continue
            straight = math.sqrt(distance * distance - 4 * radius * radius)
            heading = direction + first * math.atan2(2 * radius, straight)
        found.append((_arc(first, start[2], heading, radius), (0, straight), _arc(last, heading, goal[2], radius)))
    return found


def _with_arcs(start: Pose2, goal: Pose2, radius: float) -> list[tuple[Piece, Piece, Piece]]:
    """LRL, RLR: the middle circle touches both others."""
    found = []
    for turn in (1, -1):
        ax, ay = _centre(start, turn, radius)
        bx, by = _centre(goal, turn, radius)
        distance, direction = math.hypot(bx - ax, by - ay), math.atan2(by - ay, bx - ax)
        if distance > 4 * radius:
            continue
        aside = math.acos(distance / (4 * radius))
        for side in (1, -1):
            # from centre to centre: direction ± aside, then the mirrored way; headings are square to that
            leave = direction + side * aside + turn * math.pi / 2
            enter = direction - side * aside - turn * math.pi / 2
            middle = _arc(-turn, leave, enter, radius)
            found.append((_arc(turn, start[2], leave, radius), middle, _arc(turn, enter, goal[2], radius)))
    return found
