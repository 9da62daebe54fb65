"""Description of a robot with plain topics, one TOML file: which topics, where, of which types. No code."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Literal

from tailor.schemas.errors import UsageError
from tailor.schemas.parsed_files import read_toml
from tailor.schemas.ros2.profiles import MAX_DOMAIN
from tailor.schemas.settings import from_table

MIN_RATE_HZ, MAX_RATE_HZ = 0.1, 100.0  # the period of the least is a number; the driver's loop has the largest
MAX_START = 1e6  # m or rad; every receiver refuses a pose far beyond
MAX_STD = 1000.0  # m or rad
TOPIC = re.compile(r"/?[\w-]+(/[\w-]+)*", re.ASCII)  # zenoh opens no other key, and some are patterns

MAX_NAME = 247  # characters of a topic's name in ROS 2, of which no node could have a longer one


@dataclass(frozen=True, slots=True)
class RobotBus:
    """Where the robot's own topics are, and how their keys are made."""

    connect: str = ""  # endpoint of the robot's router or bridge; empty: Tailor's own bus, which must be open
    key: str = ""  # folder with a key for it, if its endpoint is tls/...
    profile: Literal["plain", "rmw_zenoh"] = "plain"
    domain_id: int = 0  # ROS_DOMAIN_ID, for rmw_zenoh


@dataclass(frozen=True, slots=True)
class TopicNames:
    """Names of the robot's topics; an empty pose: there is no localiser."""

    cmd_vel: str = "cmd_vel"
    odom: str = "odom"
    pose: str = "amcl_pose"


@dataclass(frozen=True, slots=True)
class Frames:
    """Frames in the headers; those of received messages are checked, unless empty."""

    cmd_vel: str = "base_link"
    odom: str = "odom"
    pose: str = "map"


@dataclass(frozen=True, slots=True)
class PoseSettings:
    """How the pose in the map follows from localiser and odometry, see pose_tracking.py."""

    start: tuple[float, ...] = ()  # x, y (m), phi (rad) when the driver opens; () waits for the localiser
    rate_hz: float = 12.5
    drift_per_m: float = 0.05
    drift_per_rad: float = 0.05
    max_std_m: float = 1.0  # beyond, the pose is unknown; without a localiser there is no limit
    max_std_rad: float = 0.5


@dataclass(frozen=True, slots=True)
class PlainSettings:
    """Content of the file; its tables and keys are the fields."""

    robot: str = ""
    command: Literal["twist", "twist_stamped"] = "twist_stamped"
    rate_hz: float = 20.0  # of the command
    obeys: bool = True  # False: what is behind the driver may hold the base, e.g. a collision monitor
    bus: RobotBus = field(default_factory=RobotBus)
    topics: TopicNames = field(default_factory=TopicNames)
    frames: Frames = field(default_factory=Frames)
    pose: PoseSettings = field(default_factory=PoseSettings)


def read_plain_settings(file: str) -> PlainSettings:
    """The settings in a file.

    Raises:
      UsageError: The file is missing or no TOML, or has wrong keys or values; the message names file and key.
    """
    settings = from_table(PlainSettings, read_toml(file, "the description of a robot"), file)
    faults = list(_faults(settings))
    if faults:
        raise UsageError(f"{file}: {'; '.join(faults)}")
    return settings


def _faults(settings: PlainSettings) -> list[str]:
    pose, topics = settings.pose, settings.topics
    faults = [] if settings.robot else ["robot is missing, expected the name of the robot in its package"]
    for name, value in (("rate_hz", settings.rate_hz), ("pose.rate_hz", pose.rate_hz)):
        if not MIN_RATE_HZ <= value <= MAX_RATE_HZ:
            faults.append(f"{name} is {value:g}, expected {MIN_RATE_HZ:g} to {MAX_RATE_HZ:g}")
    for name, value in (("pose.drift_per_m", pose.drift_per_m), ("pose.drift_per_rad", pose.drift_per_rad)):
        if not 0.0 <= value <= 1.0:
            faults.append(f"{name} is {value:g}, expected 0 to 1")
    for name, value in (("pose.max_std_m", pose.max_std_m), ("pose.max_std_rad", pose.max_std_rad)):
        if not 0.0 < value <= MAX_STD:
            faults.append(f"{name} is {value:g}, expected more than 0, up to {MAX_STD:g}")
    if pose.start and (len(pose.start) != 3 or not all(abs(value) <= MAX_START for value in pose.start)):
        faults.append(f"pose.start: expected x, y and phi, of at most {MAX_START:g}")
    elif pose.start and abs(pose.start[2]) > math.tau:  # every angle has a value within: this one is in degrees
        faults.append(f"pose.start: phi is {pose.start[2]:g}, expected radians, from -6.28 to 6.28")
    if not topics.pose and not pose.start:
        faults.append("topics.pose is empty: expected a localiser, or pose.start")
    if not topics.cmd_vel or not topics.odom:
        faults.append("topics.cmd_vel and topics.odom: expected a name each")
    names = {"cmd_vel": topics.cmd_vel, "odom": topics.odom, "pose": topics.pose}
    used = [name.lstrip("/") for name in names.values() if name]
    twice = dict.fromkeys(name for name in used if used.count(name) > 1)
    faults += [f"topics: {name!r} is named twice, expected topics of their own" for name in twice]
    faults += [
        f"topics.{each} is {name!r}, expected a name of ROS 2 such as /base/{each}"
        for each, name in names.items()
        if name and len(name) <= MAX_NAME and not TOPIC.fullmatch(name)
    ]
    faults += [
        f"topics.{each} has {len(name)} characters, expected at most {MAX_NAME}, as in ROS 2"
        for each, name in names.items()
        if len(name) > MAX_NAME
    ]
    if not 0 <= settings.bus.domain_id <= MAX_DOMAIN:
        faults.append(f"bus.domain_id is {settings.bus.domain_id}, expected 0 to {MAX_DOMAIN}")
    return faults
