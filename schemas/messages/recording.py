"""Messages for recordings, replays and evaluations: ticks, provenance and time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tailor.schemas.messages.message import Message


@dataclass(frozen=True, slots=True)
class TickReport(Message):
    """Timing of one tick and all inputs that a replay needs to repeat it."""

    stamp_ns: int
    tick: int
    now_ns: int  # time handed to the core
    lateness_ns: int  # start of the tick after its absolute deadline
    control_ns: int  # from the tick's start to the published command
    work_ns: int  # whole tick
    skipped: int  # whole periods lost before this tick
    checks_granted: int
    goal: str  # a goal accepted for this tick, empty if none
    stopping: bool  # the executive was requested to end
    input_keys: tuple[str, ...] = ()  # the four input arrays are parallel
    input_senders: tuple[str, ...] = ()
    input_sequences: tuple[int, ...] = ()
    input_arrivals_ns: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Provenance(Message):
    """Effective configuration, hashes, versions and privileges of a process, as one JSON object."""

    stamp_ns: int
    json: str


@dataclass(frozen=True, slots=True)
class Clock(Message):
    """Recorded time, for ROS 2 nodes that follow a replay with use_sim_time."""

    ROS_TYPE: ClassVar[str] = "rosgraph_msgs/msg/Clock"

    stamp_ns: int
