"""A robot with plain topics, as Hardware: Twist or TwistStamped out, Odometry and a localiser's poses in.

The robot knows nothing of Tailor: no arming, no numbers, no attachments. The driver around this class has them.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack

from tailor.runtime.bus.inbox import Source
from tailor.runtime.clock import wall_ns
from tailor.schemas.codec import decode
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import Message, Odometry, PoseEstimate
from tailor.schemas.ros2.graph import Kind
from tailor.schemas.ros2.plain import frame_in, twist_bytes
from tailor.schemas.ros2.type_mismatches import mismatches
from tailor.schemas.typesystem import ros_type
from tailor.simnodes.hardware.interface import Hardware
from tailor.simnodes.hardware.localiser_check import Doubt
from tailor.simnodes.hardware.odometry_check import OdometryCheck, RepetitionCheck
from tailor.simnodes.hardware.other_ends import OtherEnds
from tailor.simnodes.hardware.plain_keys import address, named
from tailor.simnodes.hardware.plain_settings import PlainSettings
from tailor.simnodes.hardware.pose_tracking import Drift, PoseTracker
from tailor.simnodes.hardware.robots_bus import robots_session

WAIT_S, POLL_S = 0.05, 0.002
TYPES = {"twist": "geometry_msgs/msg/Twist", "twist_stamped": "geometry_msgs/msg/TwistStamped"}


class PlainRobot(Hardware):
    """One robot; `open` connects to its bus."""

    read_s = 0.5

    def __init__(self, settings: PlainSettings, endpoint: str) -> None:
        """`endpoint`: the bus of Tailor, for a robot without one of its own."""
        self.robot = settings.robot  # type: ignore[misc]  # one of the instance: the class drives any robot
        self.write_hz = settings.rate_hz
        self._settings, self._endpoint = settings, settings.bus.connect or endpoint
        self._stack = ExitStack()
        pose = settings.pose
        start, drift = pose.start, Drift(pose.drift_per_m, pose.drift_per_rad)
        doubt = Doubt(pose.max_std_m, pose.max_std_rad) if settings.topics.pose else Doubt()
        # One for all openings: after a fault the robot stands where odometry has carried it, not at its start.
        self._tracker = PoseTracker((start[0], start[1], start[2]) if start else None, drift, doubt)
        self._check, self._repetition = OdometryCheck(), RepetitionCheck()
        self._command_sent, self._located = (0.0, 0.0), False
        self._stamps: dict[str, int] = {}
        self._pose_due_ns = 0

    def open(self) -> None:
        """Connect and subscribe."""
        settings, names = self._settings, self._settings.topics
        self._stack = ExitStack()
        session = self._stack.enter_context(robots_session(settings.bus, self._endpoint))
        self._stamps, self._pose_due_ns, self._command_sent = {}, 0, (0.0, 0.0)
        self._check, self._repetition = OdometryCheck(), RepetitionCheck()
        command = named(names.cmd_vel, TYPES[settings.command])
        self._command = session.plain_publisher(*address(settings.bus, command))
        self._ends = [(Kind.PUBLISHER, command)]
        self._sources: list[tuple[str, Source, type[Message], str]] = []  # by topic: keys of rmw_zenoh fill a line
        for name, kind, frame in (
            (names.odom, Odometry, settings.frames.odom),
            (names.pose, PoseEstimate, settings.frames.pose),
        ):
            if name:
                topic = named(name, ros_type(kind))
                source = session.plain_source(address(settings.bus, topic)[0])
                self._sources.append((topic.name, source, kind, frame))
                self._ends.append((Kind.SUBSCRIPTION, topic))
        self._other_ends = OtherEnds(command.name, names.odom.strip("/"), names.pose.strip("/"), time.monotonic())
        self._graph = session.graph_view(settings.bus.domain_id) if settings.bus.profile == "rmw_zenoh" else None

    def read(self) -> dict[str, Message]:
        """The newest odometry, and at its rate the pose that follows from it; nothing before a base takes commands."""
        self._check_ends()
        until_s = time.monotonic() + WAIT_S
        while (now_s := time.monotonic()) < until_s:
            obeyed = self._other_ends.obeys(self._command.matched(), now_s)
            moved = [message for message in self._received() if isinstance(message, Odometry)] if obeyed else []
            self._other_ends.measures(bool(moved), now_s)
            if moved:
                return {"odom": moved[-1], **self._pose(time.monotonic_ns())}
            time.sleep(POLL_S)
        return {}

    def write(self, values: tuple[float, ...]) -> None:
        """Publish the velocity."""
        stamped = self._settings.command == "twist_stamped"
        frame = self._settings.frames.cmd_vel
        self._command.publish_encoded(twist_bytes(values[0], values[1], (wall_ns(), frame) if stamped else None))
        self._command_sent = values[0], values[1]

    def close(self) -> None:
        """Disconnect; the driver has published zero before."""
        self._stack.close()

    def _check_ends(self) -> None:
        """Raise ValueError if the robot's nodes have other types on our topics, and note a localiser that nobody hears.

        ROS 2 reports neither to anybody.
        """
        announced = self._graph.announced() if self._graph else ()
        published = {each.what.name for each in announced if each.kind is Kind.PUBLISHER and each.what}
        may_speak = not self._graph or self._settings.topics.pose.strip("/") in published
        self.notice = self._other_ends.unlocated(self._located, may_speak, time.monotonic())
        for found in mismatches(self._ends, announced):
            settings = [name for name, kind in TYPES.items() if kind == found.theirs.type]
            is_command = found.kind is Kind.PUBLISHER
            raise ValueError(f"{found}; set command = '{settings[0]}'" if is_command and settings else str(found))

    def _received(self) -> Iterator[Message]:
        """New messages, taken into account for the pose; a message repeated with the same stamp is none."""
        for name, source, kind, frame in self._sources:
            while (raw := source.receive()) is not None:
                if isinstance(raw, Rejected) or not raw.is_put:
                    continue
                message = decode(kind, raw.payload)
                if isinstance(message, Rejected):
                    raise ValueError(f"{name}: {message.text}")
                found = frame_in(raw.payload)
                if frame and found != frame:
                    raise ValueError(f"{name}: its frame is '{found}', expected '{frame}' (see [frames])")
                if self._is_new(name, message):
                    yield message

    def _is_new(self, name: str, message: Message) -> bool:
        stamp_ns: int = getattr(message, "stamp_ns", 0)
        if stamp_ns and self._stamps.get(name) == stamp_ns:
            return False
        self._stamps[name] = stamp_ns
        if isinstance(message, Odometry):
            if fault := self._tracker.move(message) or self._check.fault(message):
                self._tracker.lose()
                known_again = "the localiser speaks" if self._settings.topics.pose else "the driver is started again"
                raise ValueError(f"{name}: {fault}; the pose is unknown until {known_again}")
            command = self._command_sent if self._settings.obeys else (0.0, 0.0)
            if fault := self._repetition.fault(message, command, time.monotonic()):
                raise ValueError(f"{name}: {fault}")
        elif isinstance(message, PoseEstimate):
            self._located = True
            if fault := self._tracker.correct(message):
                raise ValueError(f"{name}: {fault}")
        return True

    def _pose(self, now_ns: int) -> dict[str, Message]:
        pose = self._tracker.pose()
        if pose is None or now_ns < self._pose_due_ns:
            return {}
        period_ns = round(1e9 / self._settings.pose.rate_hz)
        self._pose_due_ns = max(self._pose_due_ns + period_ns, now_ns - period_ns)
        return {"pose": pose}
