"""What only recordings, replays and evaluations need: the ticks, their circumstances, the time, the truth."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TickReport:
    """Timing of one tick and everything that a replay needs to repeat it."""

    stamp_ns: int
    tick: int
    now_ns: int  # the time handed to the core
    lateness_ns: int  # start of the tick after its absolute deadline
    control_ns: int  # from the tick's start to the published command
    work_ns: int  # whole tick
    skipped: int  # whole periods lost before this tick
    checks_granted: int
    goal: str  # a goal accepted for this tick, empty if none
    stopping: bool  # the executive was asked to end
    input_keys: tuple[str, ...] = ()
    input_senders: tuple[str, ...] = ()
    input_sequences: tuple[int, ...] = ()
    input_arrivals_ns: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Provenance:
    """Effective configuration, hashes, versions and privileges of a process, as one JSON object."""

    stamp_ns: int
    json: str


@dataclass(frozen=True, slots=True)
class Clock:
    """rosgraph_msgs/Clock: the recorded time, for ROS 2 nodes that listen to a replay with use_sim_time."""

    stamp_ns: int


@dataclass(frozen=True, slots=True)
class SimTruth:
    """Ground truth of the soccer simulator, for pictures and evaluation; the executive never reads it."""

    stamp_ns: int
    x: float
    y: float
    phi: float
    v: float
    omega: float
    ball_x: float
    ball_y: float
    ball_vx: float
    ball_vy: float
