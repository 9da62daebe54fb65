"""What an engineer knows of a robot that drives around things: shape as circles, distances, speeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tailor.executive.interfaces.action_context import ActionContext
from tailor.executive.interfaces.values import Array, Belief
from tailor.models.features.kitchen.spaces import B21

X, Y, PHI, LONG, WIDE, RADIUS, HIGH = range(7)  # of an object: place, direction, half sizes, radius around, height
# the columns of a context that end so; others do not count
SUFFIXES = ("x", "y", "phi", "long", "wide", "r", "high")


@dataclass(frozen=True, slots=True)
class Circle:
    """A part of the robot, as seen from above.

    Attributes:
      ahead_m: Of the robot's middle.
      radius_m: Its size.
      bottom_m: Height of its lowest point: it passes over what is lower.
    """

    ahead_m: float
    radius_m: float
    bottom_m: float = 0.0

    def places(self, poses: Array) -> Array:
        """Where it is at poses of the robot, shape (n, 3); returns (n, 2)."""
        x, y, phi = poses.T
        return np.stack([x + np.cos(phi) * self.ahead_m, y + np.sin(phi) * self.ahead_m], axis=1)


@dataclass(frozen=True, slots=True)
class Geometry:
    """A robot and its habits.

    Attributes:
      circles: Its parts, the base first.
      margins_m: How far it keeps from things: bends, noise; less where there is no other way.
      spare_m: By which poses around a cylinder are farther from it than ways must be.
      passing_mps: Speed at poses on the way.
      mean_mps: For the time of a way.
      turn_radps: For the time of its turns on the spot.
      turn_first_m: So near something it turns to its way before it drives on.
    """

    circles: tuple[Circle, ...]
    margins_m: tuple[float, ...]
    spare_m: float
    passing_mps: float
    mean_mps: float
    turn_radps: float
    turn_first_m: float

    def gap_m(self, poses: Array, objects: Array) -> float:
        """The least distance between the robot at any of the poses, shape (n, 3), and any object, shape (m, 7)."""
        gaps = [
            float(distances(circle.places(poses), high).min()) - circle.radius_m
            for circle in self.circles
            if len(high := objects[objects[:, HIGH] > circle.bottom_m])
        ]
        return min(gaps, default=np.inf)


def distances(places: Array, objects: Array) -> Array:
    """Of places, shape (n, 2), from objects, shape (m, 7); returns (n, m)."""
    x, y, phi, long, wide, radius, _ = objects.T
    dx, dy = places[:, [0]] - x, places[:, [1]] - y
    c, s = np.cos(phi), np.sin(phi)
    along, aside = np.abs(c * dx + s * dy) - long, np.abs(c * dy - s * dx) - wide
    found: Array = np.hypot(np.maximum(along, 0.0), np.maximum(aside, 0.0)) - radius
    return found


def objects_of(context: ActionContext, belief: Belief) -> Array:
    """What stands there as it is believed, shape (m, 7): cylinders, and boxes if there are columns of such."""
    suffixes = [name.rpartition("_")[2] for name in context.names]
    rows = np.array(context.believed(belief)).reshape(-1, len(suffixes))
    objects = np.zeros((len(rows), len(SUFFIXES)))
    objects[:, HIGH] = np.inf
    for column, suffix in enumerate(suffixes):
        if suffix in SUFFIXES:
            objects[:, SUFFIXES.index(suffix)] = rows[:, column]
    return objects


GEOMETRIES: Mapping[str, Geometry] = {  # by domain; see docs/evaluating.md
    "soccer": Geometry(
        circles=(Circle(0.0, 0.15),),  # half its width; the margins are for the rail in bends, too
        margins_m=(0.12, 0.08, 0.05),
        spare_m=0.12,
        passing_mps=0.5,
        mean_mps=0.6,
        turn_radps=1.4,
        turn_first_m=0.6,
    ),
    "kitchen": Geometry(
        circles=(Circle(0.0, B21.base_m), *(Circle(at, B21.hand_radius_m, B21.hand_bottom_m) for at in B21.hand_m)),
        margins_m=(0.08, 0.05, 0.02),
        spare_m=0.06,
        passing_mps=0.5,
        mean_mps=0.45,
        turn_radps=0.6,
        turn_first_m=0.9,
    ),
}
