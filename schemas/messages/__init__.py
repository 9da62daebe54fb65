"""Typed values of every message on the bus; units are SI unless a name says otherwise (REP-103, REP-105).

Arrays of numbers are tuples, so that every value is frozen and comparable. Bytes are codec.py's business.
A field of an own message has the name and the order that it has in `msg/<Type>.msg`; one that stands for a standard
ROS 2 message names it, and holds what a planar robot says of it.
"""

from tailor.schemas.messages.driving import ArmRequest, DriverState, EStop, JointCommand, VelocityCommand
from tailor.schemas.messages.executing import ActionFinished, ExecStatus
from tailor.schemas.messages.planning import PlanAnswer, PlanReport, PlanRequest
from tailor.schemas.messages.recording import Clock, Provenance, SimTruth, TickReport
from tailor.schemas.messages.refining import InstantiatedAction, Parameter, RefinementReport, Subgoals
from tailor.schemas.messages.sample import Message, Sample
from tailor.schemas.messages.sensing import BallPercept, JointState, MotorCurrents, Odometry, PoseEstimate

__all__ = [
    "ActionFinished",
    "ArmRequest",
    "BallPercept",
    "Clock",
    "DriverState",
    "EStop",
    "ExecStatus",
    "InstantiatedAction",
    "JointCommand",
    "JointState",
    "Message",
    "MotorCurrents",
    "Odometry",
    "Parameter",
    "PlanAnswer",
    "PlanReport",
    "PlanRequest",
    "PoseEstimate",
    "Provenance",
    "RefinementReport",
    "Sample",
    "SimTruth",
    "Subgoals",
    "TickReport",
    "VelocityCommand",
]
