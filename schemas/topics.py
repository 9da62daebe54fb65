"""Table of topics: key, type, rate, freshness, priority, source, and whether it is recorded.

Message types, codecs, freshness limits, recording policy and documentation derive from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property, lru_cache

from tailor.schemas import messages as m
from tailor.schemas.packages.discovery import packages
from tailor.schemas.packages.package_topics import PackageTopics, add_topics
from tailor.schemas.packages.topic import Priority, Source, Topic

__all__ = ["STALE_S", "TOPICS", "Priority", "Source", "Topic", "is_rate", "key_of", "nominal_rates_hz", "reports"]

STALE_S = 0.5  # Autoware's heartbeat limit; five ticks
MAX_RATE_HZ = 1e6  # beyond any sensor

_SHIPPED: dict[str, Topic] = {
    "cmd_vel": Topic("{robot}/cmd_vel", m.VelocityCommand, 10, "executive", priority="real_time"),
    "odom": Topic("{robot}/odom", m.Odometry, 50, "driver", STALE_S, "interactive_high"),
    "pose": Topic("{robot}/pose", m.PoseEstimate, 12.5, "driver", 1.0),
    "joint_cmd": Topic("{robot}/joint_cmd", m.JointCommand, 10, "executive", priority="real_time"),
    "joint_states": Topic("{robot}/joint_states", m.JointState, 50, "driver", STALE_S, "interactive_high"),
    "currents": Topic("{robot}/currents", m.MotorCurrents, 10, "driver"),
    "driver": Topic("{robot}/driver", m.DriverState, 10, "driver", STALE_S, "interactive_high"),
    "arm_request": Topic("{robot}/arm_request", m.ArmRequest, 0, "people", priority="interactive_high"),
    "self_arm": Topic("{robot}/self_arm", m.ArmRequest, 0, "executive", priority="interactive_high"),  # by its leave
    "estop": Topic("estop", m.EStop, 0, "people", priority="real_time"),
    "clock": Topic("clock", m.Clock, 0, "player", recorded=False),  # of a replay
    "planar_truth": Topic("{robot}/sim/pose", m.PlanarTruth, 10, "simulator"),
    "joint_truth": Topic("{robot}/sim/joints", m.JointState, 10, "simulator"),
    "scene": Topic("{robot}/scene", m.SceneShapes, 5, "scene", max_bytes=1 << 17),
    "scene_truth": Topic("{robot}/sim/scene", m.SceneShapes, 5, "scene", max_bytes=1 << 17),
    "transforms": Topic("tf", m.FrameTransforms, 10, "scene", max_bytes=16384),  # ROS 2 knows one for all robots
    "log": Topic("rosout", m.LogLine, 0, "scene"),
    "status": Topic("exec/status", m.ExecStatus, 10, "executive", max_bytes=16384),
    "finished": Topic("exec/finished", m.ActionFinished, 0, "executive"),
    "plan": Topic("exec/plan", m.PlanReport, 0, "executive", max_bytes=65536),
    "plan_request": Topic("exec/plan_request", m.PlanRequest, 0, "executive", max_bytes=1 << 20),
    "plan_answer": Topic("exec/plan_answer", m.PlanAnswer, 0, "executive", max_bytes=1 << 20),  # of the shell
    "subgoals": Topic("exec/subgoals", m.Subgoals, 0, "executive", max_bytes=65536),
    "contexts": Topic("exec/contexts", m.Contexts, 0, "executive", max_bytes=65536),
    "refinement": Topic("exec/refinement", m.RefinementReport, 0, "executive", max_bytes=65536),
    "tick": Topic("exec/tick", m.TickReport, 10, "executive", max_bytes=65536),
    "provenance": Topic("exec/provenance", m.Provenance, 1, "executive", max_bytes=262144),
    "processes": Topic("launch/processes", m.ProcessStates, 1, "launcher"),
}


class TopicTable(Mapping[str, Topic]):
    """The topics that ship, and those of packages of robots.

    The packages are read when the table is iterated over, or for a name that does not ship: an e-stop waits for none.
    """

    def __getitem__(self, name: str) -> Topic:
        """Topic of a name."""
        shipped = _SHIPPED.get(name)
        return self._read.topics[name] if shipped is None else shipped

    def __iter__(self) -> Iterator[str]:
        """Names: those that ship first."""
        return iter(self._read.topics)

    def __len__(self) -> int:
        """Number of topics."""
        return len(self._read.topics)

    @property
    def faults(self) -> Mapping[str, tuple[str, ...]]:
        """What is wrong with the topics of packages, by the package's name."""
        return self._read.faults

    @cached_property
    def _read(self) -> PackageTopics:
        return add_topics(_SHIPPED, packages())


TOPICS = TopicTable()


def nominal_rates_hz(names: Iterable[str]) -> dict[str, float]:
    """Rates of topics in the table, by name; names that it does not have are left out."""
    return {name: TOPICS[name].rate_hz for name in names if name in TOPICS}


def is_rate(value: object) -> bool:
    """Whether a value from outside is a rate in Hz."""
    return isinstance(value, int | float) and not isinstance(value, bool) and 0.0 <= value <= MAX_RATE_HZ


def reports() -> tuple[str, ...]:
    """Names of the topics on which every executive reports, whatever its robot."""
    return tuple(name for name, topic in _SHIPPED.items() if topic.key.startswith("exec/"))


@lru_cache(maxsize=1024)  # a tick looks up a dozen, always the same
def key_of(name: str, robot: str) -> str:
    """The zenoh key of a topic, e.g. `key_of("odom", "agilo") == "agilo/odom"`."""
    return TOPICS[name].key.format(robot=robot)
