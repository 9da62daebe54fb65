"""What a robot's package declares of its looks: shapes and frames, from the belief and from the ground truth.

One source for the page of a run, for pictures, and for markers and transforms on the bus. The spec's field `scene`
names an object, usually a module, with the attributes of `SceneView`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

from tailor.schemas.messages import Message
from tailor.schemas.messages.scenes import ARROW, BOX, CYLINDER, LINE, SPHERE, TEXT, FrameTransform, Shape
from tailor.schemas.packages.pose3 import Pose3, Vector

Colour = tuple[float, float, float, float]  # red, green, blue, opacity: 0..1

MAP, ODOM, BASE = "map", "odom", "base_link"  # frames of REP-105
GREY, DARK, ORANGE, BLUE = (0.6, 0.62, 0.65, 1.0), (0.2, 0.22, 0.25, 1.0), (1.0, 0.45, 0.1, 1.0), (0.2, 0.45, 0.8, 1.0)
LIFETIME_S = 2.0  # ten periods of the markers
UPRIGHT = Pose3()


@dataclass(frozen=True, slots=True)
class Scene:
    """A robot and its surroundings at one time.

    Attributes:
      frames: Poses of frames, parents first; they lead from "map" to every frame of a shape.
      shapes: What is seen; names are unique.
      tracer: The frame whose way is drawn: that of a mobile robot, or of an arm's tool.
      speed_mps: Its speed, along its own x axis where it has a heading.
    """

    frames: tuple[FrameTransform, ...] = ()
    shapes: tuple[Shape, ...] = ()
    tracer: str = BASE
    speed_mps: float = 0.0


class SceneView(Protocol):
    """What a spec's `scene` names. All functions are pure.

    Two more are optional. `of_object(values)` returns the shape of an object that an action takes into account, by the
    names of its context's columns, or None; the last ones decided with are drawn in the believed scene. Names of shapes
    must not repeat there. `of_target(values)` returns where the robot is to work at a subgoal, or None: the spot of a
    cup where `of_subgoal` is the robot's stand before it.

    Attributes:
      VIEW: Side from which pages and pictures look: "above", or "behind": along x, with z upward. Default: "above".
    """

    def of_belief(self, values: Mapping[str, float]) -> Scene:
        """The believed scene.

        Args:
          values: `belief_values` of the domain by name, without the units: {"x": 1.0, "ball_x": …}. The last ones may
            be missing, as the domain permits.
        """
        ...

    def of_truth(self, message: Message) -> Scene:
        """The true scene, or the part of it in one message of a simulator's topic; an empty one for other messages."""
        ...

    def of_subgoal(self, values: Mapping[str, float]) -> Pose3 | None:
        """Pose in "map" of a subgoal with these values by quantity, e.g. {"x": …, "y": …, "phi": …}.

        None: it has no place, and scenes leave it out. A subgoal with all quantities of an action must have one if
        any of them is in metres, the unit that marks a place.
        """
        ...


def frame(child: str, pose: Pose3, parent: str = MAP) -> FrameTransform:
    """A frame by its pose in its parent."""
    return FrameTransform(parent, child, pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw)


def box(name: str, size: Vector, pose: Pose3 = UPRIGHT, colour: Colour = GREY, frame: str = BASE) -> Shape:
    """A box with its centre at the pose; size along its own axes, m."""
    return _shape(name, BOX, size, pose, colour, frame)


def cylinder(
    name: str, radius_m: float, height_m: float, pose: Pose3 = UPRIGHT, colour: Colour = GREY, frame: str = BASE
) -> Shape:
    """A cylinder about its own z axis with its centre at the pose."""
    return _shape(name, CYLINDER, (2 * radius_m, 2 * radius_m, height_m), pose, colour, frame)


def sphere(name: str, radius_m: float, pose: Pose3 = UPRIGHT, colour: Colour = ORANGE, frame: str = MAP) -> Shape:
    """A sphere with its centre at the pose."""
    return _shape(name, SPHERE, (2 * radius_m,) * 3, pose, colour, frame)


def arrow(
    name: str, length_m: float, pose: Pose3 = UPRIGHT, colour: Colour = DARK, frame: str = MAP, width_m: float = 0.05
) -> Shape:
    """An arrow from the pose along its x axis."""
    return _shape(name, ARROW, (length_m, width_m, width_m), pose, colour, frame)


def line(name: str, points: Iterable[Vector], width_m: float = 0.02, colour: Colour = GREY, frame: str = MAP) -> Shape:
    """A line through points, m."""
    numbers = tuple(number for point in points for number in point)
    return _shape(name, LINE, (width_m, 0.0, 0.0), UPRIGHT, colour, frame, points=numbers)


def text(name: str, words: str, pose: Pose3, height_m: float = 0.15, colour: Colour = DARK, frame: str = MAP) -> Shape:
    """Words that face the viewer."""
    return _shape(name, TEXT, (0.0, 0.0, height_m), pose, colour, frame, words)


def _shape(
    name: str,
    kind: int,
    size: Vector,
    pose: Pose3,
    colour: Colour,
    frame: str,
    words: str = "",
    points: tuple[float, ...] = (),
) -> Shape:
    place = (pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw)
    return Shape(name, kind, frame, *place, *size, *colour, LIFETIME_S, words, points)


def pose_of(placed: Shape | FrameTransform) -> Pose3:
    """Pose of a shape or a frame in its parent."""
    return Pose3(placed.x, placed.y, placed.z, placed.qx, placed.qy, placed.qz, placed.qw)


def on_map(frames: Iterable[FrameTransform]) -> dict[str, Pose3]:
    """Pose of every frame in "map"; a frame whose parent does not come before it is left out."""
    return frames_below(frames, MAP)


def frames_below(frames: Iterable[FrameTransform], root: str) -> dict[str, Pose3]:
    """Pose in the frame `root` of it and of every frame that descends from it; parents come first."""
    known = {root: UPRIGHT}
    for each in frames:
        if each.parent in known:
            parent = known[each.parent]
            known[each.child] = pose_of(each) if parent is UPRIGHT else parent.then(pose_of(each))
    return known
