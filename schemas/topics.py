"""Table of topics: key, type, rate, freshness, priority, source, and whether it is recorded.

Message types, codecs, freshness limits, recording policy and documentation derive from it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from tailor.schemas import messages as m
from tailor.schemas.messages import soccer

Priority = Literal["real_time", "interactive_high", "data"]
Source = Literal["driver", "executive", "people", "simulator", "player", "launcher"]


@dataclass(frozen=True, slots=True)
class Topic:
    """One row of the table; `{robot}` in a key is a placeholder for the robot's name."""

    key: str
    type: type[m.Message]
    rate_hz: float  # 0: on demand or on change
    source: Source
    fresh_s: float | None = None  # a message older than this is stale; None: never
    priority: Priority = "data"
    recorded: bool = True
    max_bytes: int = 4096

    @property
    def drives(self) -> bool:
        """Whether it moves, arms or stops a robot."""
        return self.priority == "real_time" or self.type is m.ArmRequest


STALE_S = 0.5  # Autoware's heartbeat limit; five ticks

TOPICS: dict[str, Topic] = {
    "cmd_vel": Topic("{robot}/cmd_vel", m.VelocityCommand, 10, "executive", priority="real_time"),
    "odom": Topic("{robot}/odom", m.Odometry, 50, "driver", STALE_S, "interactive_high"),
    "pose": Topic("{robot}/pose", m.PoseEstimate, 12.5, "driver", 1.0),
    "ball": Topic("{robot}/ball", soccer.BallPercept, 12.5, "driver"),
    "joint_cmd": Topic("{robot}/joint_cmd", m.JointCommand, 10, "executive", priority="real_time"),
    "joint_states": Topic("{robot}/joint_states", m.JointState, 50, "driver", STALE_S, "interactive_high"),
    "currents": Topic("{robot}/currents", m.MotorCurrents, 10, "driver"),
    "driver": Topic("{robot}/driver", m.DriverState, 10, "driver", STALE_S, "interactive_high"),
    "arm_request": Topic("{robot}/arm_request", m.ArmRequest, 0, "people", priority="interactive_high"),
    "self_arm": Topic("{robot}/self_arm", m.ArmRequest, 0, "executive", priority="interactive_high"),  # by its leave
    "estop": Topic("estop", m.EStop, 0, "people", priority="real_time"),
    "clock": Topic("clock", m.Clock, 0, "player", recorded=False),  # of a replay
    "truth": Topic("{robot}/sim/truth", soccer.SoccerGroundTruth, 10, "simulator"),
    "joint_truth": Topic("{robot}/sim/joints", m.JointState, 10, "simulator"),
    "status": Topic("exec/status", m.ExecStatus, 10, "executive", max_bytes=16384),
    "finished": Topic("exec/finished", m.ActionFinished, 0, "executive"),
    "plan": Topic("exec/plan", m.PlanReport, 0, "executive", max_bytes=65536),
    "plan_request": Topic("exec/plan_request", m.PlanRequest, 0, "executive", max_bytes=1 << 20),
    "plan_answer": Topic("exec/plan_answer", m.PlanAnswer, 0, "executive", max_bytes=1 << 20),  # of the shell
    "subgoals": Topic("exec/subgoals", m.Subgoals, 0, "executive", max_bytes=65536),
    "refinement": Topic("exec/refinement", m.RefinementReport, 0, "executive", max_bytes=65536),
    "tick": Topic("exec/tick", m.TickReport, 10, "executive", max_bytes=65536),
    "provenance": Topic("exec/provenance", m.Provenance, 1, "executive", max_bytes=262144),
    "processes": Topic("launch/processes", m.ProcessStates, 1, "launcher"),
}


@lru_cache(maxsize=1024)  # a tick looks up a dozen, always the same
def key_of(name: str, robot: str) -> str:
    """The zenoh key of a topic, e.g. `key_of("odom", "agilo") == "agilo/odom"`."""
    return TOPICS[name].key.format(robot=robot)
