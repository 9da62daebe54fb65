"""Makes markers and transforms from the other messages of a run, for viewers in 3D.

They are derived: from what the executive, the driver and the simulator publish, never from what they hold. So any
recording can be given them afterwards, and no tick waits for them.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace

from tailor.schemas import messages as m
from tailor.schemas.errors import Rejected
from tailor.schemas.packages.pose3 import Pose3, on_plane
from tailor.schemas.packages.scene import BASE, MAP, ODOM, Scene, arrow, frame, line, on_map, pose_of, sphere, text
from tailor.schemas.parsed_files import table_of
from tailor.schemas.topics import TOPICS, key_of
from tailor.tools.scenes.driver_starts import DriverStarts
from tailor.tools.scenes.robot_scenes import TRUTH_KEYS, RobotScenes, Subgoal
from tailor.tools.scenes.run_log import RunLog

SHAPES_S, FRAMES_S = 0.16, 0.06  # between two messages: 5 and 10 a second, from inputs of 10 with jitter
MAX_SHAPES, MAX_POINTS, MAX_WORDS = 200, 1500, 100  # of a scene; of its lines together; characters of a name or text
WAY_POINTS, WAY_STEP_M = 400, 0.02  # of the drawn way
GREEN, INK, WAY, PALE = (0.1, 0.65, 0.3, 1.0), (0.1, 0.1, 0.12, 1.0), (0.2, 0.45, 0.8, 0.9), 0.45
LABEL_M = 0.35  # above what it names

INPUTS = tuple(TOPICS[name].key for name in ("provenance", "status", "contexts", "subgoals", "finished", "plan"))
WANTED = TRUTH_KEYS | {TOPICS[name].key.partition("/")[2] for name in ("odom", "driver")}  # of a robot

Published = tuple[str, m.Message]  # name of a topic, and what is published there


class SceneFeed:
    """Scenes of one run.

    Args:
      domain: Domain of the run; empty: that of the first executive that is heard.
    """

    def __init__(self, domain: str = "") -> None:
        self._scenes = RobotScenes(domain) if domain else None
        self._odometry: m.Odometry | None = None
        self._subgoals: tuple[Subgoal, ...] = ()
        self._starts = DriverStarts()
        self._restarted = False  # the driver has, and no action has begun since
        self._way: deque[tuple[float, float, float]] = deque(maxlen=WAY_POINTS)
        self._status: m.ExecStatus | None = None
        self._sent_s: dict[str, float] = {}  # by topic
        self._log = RunLog()

    @property
    def robot(self) -> str:
        """Name of the robot; empty while it is not known."""
        return self._scenes.robot if self._scenes else ""

    @property
    def fault(self) -> str:
        """What the robot's package raised instead of a scene; empty: nothing."""
        return self._scenes.fault if self._scenes else ""

    @staticmethod
    def wants(key: str) -> bool:
        """Whether messages of this key matter: others need not be decoded."""
        return key in INPUTS or key.partition("/")[2] in WANTED

    def messages_after(self, at_s: float, key: str, message: m.Message) -> list[Published]:
        """Take in one message; return what follows from it.

        Args:
          at_s: Time of its reception.
          key: Its key.
          message: Its value.
        """
        lines = [] if self._scenes is None else [("log", line) for line in self._log.lines_of(key, message)]
        return [*self._drawn(at_s, key, message), *lines]

    def _drawn(self, at_s: float, key: str, message: m.Message) -> list[Published]:
        if isinstance(message, m.Provenance) and self._scenes is None:
            domain = domain_of(message)
            self._scenes = RobotScenes(domain) if domain else None
        elif isinstance(message, m.Odometry) and key == key_of("odom", self.robot):
            self._odometry = message
        elif isinstance(message, m.DriverState) and key == key_of("driver", self.robot):
            self._restarted = self._starts.is_another(message) or self._restarted
        elif isinstance(message, m.Contexts) and self._scenes is not None:
            self._scenes.note(message)
        elif isinstance(message, m.Subgoals) and self._scenes is not None:
            self._subgoals = self._scenes.of_subgoals(message)
        elif isinstance(message, m.ExecStatus) and self._scenes is not None:
            return self._believed(at_s, message, self._scenes)
        elif self._scenes is not None and key.partition("/")[0] == self.robot and key.partition("/")[2] in TRUTH_KEYS:
            return self._true(at_s, message, self._scenes)
        return []

    def _believed(self, at_s: float, status: m.ExecStatus, scenes: RobotScenes) -> list[Published]:
        if self._restarted or (self._status is not None and status.action_index < self._status.action_index):
            self._way.clear()  # a simulator has put the robot elsewhere, and it is believed there by the next action
        self._restarted = self._restarted and not status.action
        self._status = status
        scene = scenes.of_belief(status.belief)
        if scene is None:
            return []
        tracer = on_map(scene.frames).get(scene.tracer)
        self._extend_way(tracer)
        published: list[Published] = []
        if self._odometry is None and scenes.has_odometry:
            return []  # base_link must not change its parent when odometry comes
        if self._due("transforms", at_s, FRAMES_S):
            published.append(("transforms", m.FrameTransforms(status.stamp_ns, self._frames(scene))))
        if self._due("scene", at_s, SHAPES_S):
            shapes = (*scene.shapes, *self._marks(scenes, status, tracer))
            published.append(("scene", m.SceneShapes(status.stamp_ns, bounded(shapes))))
        return published

    def _true(self, at_s: float, message: m.Message, scenes: RobotScenes) -> list[Published]:
        scene = scenes.of_truth(message)
        if scene is None or not self._due("scene_truth", at_s, SHAPES_S):
            return []
        stamp_ns = self._status.stamp_ns if self._status else getattr(message, "stamp_ns", 0)
        return [("scene_truth", m.SceneShapes(stamp_ns, bounded(grounded(scene))))]

    def _frames(self, scene: Scene) -> tuple[m.FrameTransform, ...]:
        """Frames of the belief; with odometry, odom stands between map and base_link (REP-105)."""
        if self._odometry is None:
            return scene.frames
        odom = on_plane(self._odometry.x, self._odometry.y, self._odometry.phi)
        frames: list[m.FrameTransform] = []
        for each in scene.frames:
            if (each.parent, each.child) == (MAP, BASE):
                frames += [frame(ODOM, pose_of(each).then(odom.inverse())), frame(BASE, odom, ODOM)]
            else:
                frames.append(each)
        return tuple(frames)

    def _marks(self, scenes: RobotScenes, status: m.ExecStatus, tracer: Pose3 | None) -> list[m.Shape]:
        """Subgoals, the way so far, and what the robot does."""
        marks = []
        for goal in self._subgoals if status.action else ():
            colour, pose = GREEN if goal.free else INK, goal.pose
            mark = arrow("", 0.36, pose, colour) if goal.headed else sphere("", 0.02, pose, colour)
            name = Pose3(pose.x, pose.y, pose.z + (0.15 if scenes.seen_from == "above" else 0.05))
            height_m = 0.12 if scenes.seen_from == "above" else 0.04
            marks += [
                replace(mark, name=f"subgoal {goal.label}"),
                text(f"label {goal.label}", goal.label, name, height_m, colour),
            ]
            if goal.target is not None:
                marks.append(sphere(f"target {goal.label}", 0.02, goal.target, colour))
        if len(self._way) > 1:
            marks.append(line("way", self._way, 0.015, WAY))
        if tracer is not None:
            above = Pose3(tracer.x, tracer.y, tracer.z + LABEL_M)
            marks.append(text("doing", status.action or status.mode.lower() or "-", above, 0.1, INK))
        return marks

    def _extend_way(self, tracer: Pose3 | None) -> None:
        if tracer is None:
            return
        last = self._way[-1] if self._way else None
        if last is None or abs(tracer.x - last[0]) + abs(tracer.y - last[1]) + abs(tracer.z - last[2]) > WAY_STEP_M:
            self._way.append((tracer.x, tracer.y, tracer.z))

    def _due(self, topic: str, at_s: float, period_s: float) -> bool:
        if 0.0 <= at_s - self._sent_s.get(topic, -1e9) < period_s:
            return False
        self._sent_s[topic] = at_s
        return True


def grounded(scene: Scene) -> list[m.Shape]:
    """The shapes in "map", pale: the truth is no part of the tree of frames, which is the belief's."""
    frames = on_map(scene.frames)
    shapes = []
    for shape in scene.shapes:
        if shape.frame in frames:
            at = frames[shape.frame].then(pose_of(shape))
            moved = replace(shape, x=at.x, y=at.y, z=at.z, qx=at.qx, qy=at.qy, qz=at.qz, qw=at.qw)
            shapes.append(replace(moved, frame=MAP, alpha=shape.alpha * PALE))
    return shapes


def bounded(shapes: tuple[m.Shape, ...] | list[m.Shape]) -> tuple[m.Shape, ...]:
    """The shapes that a message may carry, with shortened words and lines: its size is limited, whoever draws."""
    left, kept = MAX_POINTS, []
    for shape in shapes[:MAX_SHAPES]:
        points = shape.points[: 3 * left]
        left -= len(points) // 3
        kept.append(replace(shape, name=shape.name[:MAX_WORDS], text=shape.text[:MAX_WORDS], points=points))
    return tuple(kept)


def domain_of(provenance: m.Provenance) -> str:
    """Name of the domain of a run; empty if it has none."""
    table = table_of(provenance.json)
    config = {} if isinstance(table, Rejected) else table.get("config")
    domain = config.get("domain") if isinstance(config, dict) else None
    return domain if isinstance(domain, str) else ""
