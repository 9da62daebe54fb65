"""Any message, and a message as it arrived."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.schemas.messages.driving import ArmRequest, DriverState, EStop, JointCommand, VelocityCommand
from tailor.schemas.messages.executing import ActionFinished, ExecStatus
from tailor.schemas.messages.planning import PlanAnswer, PlanReport, PlanRequest
from tailor.schemas.messages.recording import Clock, Provenance, SimTruth, TickReport
from tailor.schemas.messages.refining import RefinementReport, Subgoals
from tailor.schemas.messages.sensing import BallPercept, JointState, MotorCurrents, Odometry, PoseEstimate

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
    sender: str = ""  # 32 hex digits
