"""Typed values of every message on the bus; units are SI unless a name says otherwise (REP-103, REP-105).

Arrays of numbers are tuples, so that every value is frozen and comparable. Bytes are codec.py's business.
A field of an own message has the name and the order that it has in `msg/<Type>.msg`.
"""

from __future__ import annotations

from dataclasses import dataclass, field


# --- standard ROS 2 messages, reduced to what a planar robot says ---------------------------------
@dataclass(frozen=True, slots=True)
class VelocityCommand:
    """geometry_msgs/TwistStamped: linear.x in m/s, angular.z in rad/s, base_link frame."""

    stamp_ns: int
    v: float
    omega: float


@dataclass(frozen=True, slots=True)
class Odometry:
    """nav_msgs/Odometry: dead-reckoned pose in odom frame (m, rad), velocity in base_link (m/s, rad/s)."""

    stamp_ns: int
    x: float
    y: float
    phi: float
    v: float
    omega: float


@dataclass(frozen=True, slots=True)
class PoseEstimate:
    """geometry_msgs/PoseWithCovarianceStamped: absolute pose in the map frame, variances in m² and rad²."""

    stamp_ns: int
    x: float
    y: float
    phi: float
    var_x: float
    var_y: float
    var_phi: float


@dataclass(frozen=True, slots=True)
class EStop:
    """std_msgs/Bool: true stops and latches every driver; it takes an ArmRequest with `reset` to leave."""

    stop: bool


@dataclass(frozen=True, slots=True)
class Clock:
    """rosgraph_msgs/Clock: the recorded time, for ROS 2 nodes that listen to a replay with use_sim_time."""

    stamp_ns: int


@dataclass(frozen=True, slots=True)
class JointState:
    """sensor_msgs/JointState: rad, rad/s and N·m of each named joint; all tuples have one length."""

    stamp_ns: int
    names: tuple[str, ...] = ()
    positions: tuple[float, ...] = ()
    velocities: tuple[float, ...] = ()
    efforts: tuple[float, ...] = ()


# --- own messages: tailor_msgs ---------------------------------------------------------------------
@dataclass(frozen=True, slots=True)
class BallPercept:
    """The ball as the camera sees it: position in base_link (m), covariance (m²), x ahead, y left."""

    stamp_ns: int
    x: float
    y: float
    var_x: float
    var_y: float
    cov_xy: float


@dataclass(frozen=True, slots=True)
class JointCommand:
    """Velocity set-points of named joints, rad/s; the driver closes the current loop (paper Table 5)."""

    stamp_ns: int
    names: tuple[str, ...] = ()
    velocities: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class MotorCurrents:
    """Motor currents in A since the last message of this kind: the one of now, and the largest magnitude."""

    stamp_ns: int
    names: tuple[str, ...] = ()
    amperes: tuple[float, ...] = ()
    peak_amperes: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class DriverState:
    """What a driver says of itself: mode (disarmed, armed, stopped, estopped), why, whom it obeys."""

    stamp_ns: int
    mode: str
    reason: str
    epoch: int  # changes with every start of the driver
    armed_sender: str  # 32 hex digits, empty while disarmed
    accepted: int  # commands since start
    refused_reasons: tuple[str, ...] = ()
    refused_counts: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class ArmRequest:
    """Arm or disarm a driver for one sender; `reset` also leaves a latched e-stop."""

    arm: bool
    reset: bool
    sender: str  # 32 hex digits; empty: the sender of this message
    epoch: int  # the driver's epoch that is meant; 0: whichever


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


@dataclass(frozen=True, slots=True)
class ExecStatus:
    """The executive's state at the end of a tick."""

    stamp_ns: int
    tick: int
    mode: str  # DISARMED READY EXECUTING HOLDING FAULT
    reason: str
    scenario: str
    goal: str
    result: str  # "", "achieved", "failed: why"
    action: str  # e.g. "goToPose", empty between actions
    action_index: int
    action_elapsed_s: float
    action_predicted_s: float
    belief: tuple[float, ...] = ()  # in the order of the domain's belief_names
    sender: str = ""  # this executive's sender id, 32 hex digits


@dataclass(frozen=True, slots=True)
class ActionFinished:
    """One action ended: how, and how long it took against what was predicted."""

    stamp_ns: int
    tick: int
    action: str
    action_index: int
    outcome: str  # "done", "failed", "aborted"
    reason: str
    predicted_s: float
    actual_s: float


@dataclass(frozen=True, slots=True)
class PlanReport:
    """A plan in VHPOP's causal-link form, and how the executive came by it."""

    stamp_ns: int
    status: str  # solved unsolvable limit unsupported, failed (the external planner)
    way: str  # "searched", "suffix", "improved" (found while the action before it ran), "external"
    plan: str
    generated: int
    visited: int
    reason: str


@dataclass(frozen=True, slots=True)
class PlanRequest:
    """What the executive asks its external planner: PDDL of the domain, and of the problem from the facts of now."""

    stamp_ns: int
    id: int
    domain: str
    problem: str


@dataclass(frozen=True, slots=True)
class PlanAnswer:
    """How the external planner ended, as it was handed to the executive's core: an input, recorded for replay."""

    stamp_ns: int
    id: int  # of the request
    outcome: str  # "answered", "crashed", "timeout", "flood", "missing"
    output: str  # what it printed, if it answered: not believed yet
    reason: str


@dataclass(frozen=True, slots=True)
class Parameter:
    """An instantiated action parameter; equal ids are one variable (paper 6.2.2)."""

    name: str
    id: int
    label: str
    unit: str
    bound: bool
    lower: float
    upper: float
    value: float


@dataclass(frozen=True, slots=True)
class InstantiatedAction:
    """An executable action with its parameters and what its model predicts for the chosen values."""

    action: str
    step: int
    asserted: bool
    predicted_s: float
    spread_s: float
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class Subgoals:
    """The action sequence that is being executed, with the chosen values of its free parameters."""

    stamp_ns: int
    tick: int
    horizon: int
    actions: tuple[InstantiatedAction, ...] = ()


@dataclass(frozen=True, slots=True)
class RefinementReport:
    """The refinement's search: what greedy would have cost, the best so far, and what it took; -1 s is INVALID."""

    stamp_ns: int
    tick: int
    horizon: int
    solver: str
    finished: bool
    evaluations: int
    checks: int
    greedy_s: float
    best_s: float
    trace_evaluations: tuple[int, ...] = ()
    trace_best_s: tuple[float, ...] = ()
    situation: tuple[float, ...] = ()  # what a benefit tree sees of both choices; its card names the values
    slower: float = -1.0  # the tree's risk that refining costs time, 0..1 (paper 6.3.2); -1: it was not asked
    kept_greedy: bool = False  # the tree advised against refining
    gap_pct: float = -1.0  # proven: best_s is at most so much above the models' optimum; -1: not certified


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


Message = (
    VelocityCommand
    | Odometry
    | PoseEstimate
    | EStop
    | Clock
    | JointState
    | JointCommand
    | MotorCurrents
    | BallPercept
    | DriverState
    | ArmRequest
    | SimTruth
    | ExecStatus
    | ActionFinished
    | PlanReport
    | PlanRequest
    | PlanAnswer
    | Subgoals
    | RefinementReport
    | TickReport
    | Provenance
)


@dataclass(frozen=True, slots=True)
class Sample:
    """A message as it arrived: who sent it, as which number of theirs, and when, by the receiver's clock."""

    key: str
    message: Message
    arrival_ns: int  # receiver's monotonic clock
    sequence: int
    sender: str = field(default="")  # 32 hex digits
