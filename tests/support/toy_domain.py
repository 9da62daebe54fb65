"""A robot on a line, to test the core without any real robot: it slides to places, at a speed that is free."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tailor.executive.core.state import Inputs
from tailor.executive.deliberation.context import Context, Settings, make_context
from tailor.executive.interfaces.action import Action, Control, Parameter
from tailor.executive.interfaces.domain import Axis, Scenario
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Interval
from tailor.schemas.messages import DriverState, Odometry, Sample, VelocityCommand

PDDL = """
(define (domain line) (:requirements :strips)
  (:predicates (at ?p) (visited ?p) (place ?p))
  (:action slide :parameters (?from ?to)
    :precondition (and (at ?from) (place ?to))
    :effect (and (not (at ?from)) (at ?to) (visited ?to))))
"""
PROBLEM = """
(define (problem two-places) (:domain line) (:objects home a b)
  (:init (at home) (place a) (place b)) (:goal (and (visited a) (visited b) (at b))))
"""
SENDER = "ab" * 16
TOLERANCE_M = 0.05
CREEP_MPS = 0.01
CLOSED = 9.0  # a shift that means: no place can be reached any more


@dataclass(frozen=True, slots=True)
class LineBelief:
    x: float = 0.0
    seen: bool = False
    shift: float = 0.0  # how far the places have moved, for tests
    carried: int = 0  # how often the robot was, for tests


def slide(state, now_ns, belief, arguments):
    """Go to arguments[1] at up to arguments[2] m/s, creeping on arrival; goals beyond 90 fail, below -5 are nan."""
    goal, speed = arguments[1], arguments[2]
    error = goal - belief.x
    if goal > 90:
        return Control(state, (0.0,), "failed", "too far")
    if goal < -5:
        return Control(state, (float("nan"),))
    if abs(error) < TOLERANCE_M:
        return Control(state, (CREEP_MPS,), "done")
    return Control(state, (float(np.sign(error) * min(speed, abs(error) * 5)),))


class LineModel:
    """Distance over speed, and the faster the better."""

    card = {"sha256": "toy"}

    def predict(self, arguments):
        return np.abs(arguments[:, 1] - arguments[:, 0]) / arguments[:, 2], np.zeros(len(arguments))


SLIDE = Action(
    "slide",
    (
        Parameter("x", 0, "x", "m", -10, 100),
        Parameter("xg", 1, "x", "m", -10, 100, tolerance=0.2),
        Parameter("v", 1, "v", "m/s", 0.1, 0.5),
    ),
    slide,
    "slide/duration",
)


class LineDomain:
    name = "line"
    robot = "agilo"
    pddl = PDDL
    actions = {"slide": SLIDE}
    executables = {"slide": "slide"}
    axes = (Axis("v", "m/s", -0.5, 0.5),)
    command_topic = "cmd_vel"
    sensors = ("odom",)
    required = ("odom",)
    belief_names = ("x (m)",)

    def initial_belief(self):
        return LineBelief()

    def update(self, belief, now_ns, samples, command):
        for sample in samples:
            if isinstance(sample.message, Odometry):
                belief = replace(belief, x=sample.message.x, shift=sample.message.y, seen=True)
        return belief

    def ready(self, belief):
        return belief.seen

    def belief_values(self, belief):
        return (belief.x,)

    def anchor(self, belief, scenario, remembered):
        return frozenset(f for f in remembered if belief.shift != CLOSED or f[0] != "place")

    def value(self, query):
        if query.quantity != "x":
            return None
        if ("at", query.label) in query.holds:
            return Interval(query.belief.x, query.belief.x)
        x = query.scenario.places[query.label]["x"] + query.belief.shift
        return Interval(x, x)

    def message(self, command, stamp_ns):
        return VelocityCommand(stamp_ns, command[0], 0.0)


def line_context(settings: Settings | None = None, places=None, problem: str = PROBLEM) -> Context:
    places = places or {"home": {"x": 0.0}, "a": {"x": 0.5}, "b": {"x": 1.0}}
    scenario = Scenario("two-places", problem, places)
    models = Models({"slide/duration": LineModel()}, {})
    return make_context(LineDomain(), scenario, models, settings or Settings(), SENDER)


def odometry(now_ns: int, x: float, tick: int, shift: float = 0.0) -> Sample:
    """The newest of a tick's five samples."""
    return Sample("agilo/odom", Odometry(now_ns, x, shift, 0.0, 0.0, 0.0), now_ns, 5 * tick, "cd" * 16)


def driver(now_ns: int, mode: str = "armed", epoch: int = 7, sender: str = SENDER, accepted: int = 1) -> Sample:
    state = DriverState(now_ns, mode, "", "", epoch, sender if mode == "armed" else "", accepted)
    return Sample("agilo/driver", state, now_ns, now_ns // 1000 + 1, "cd" * 16)


def inputs(now_ns: int, x: float, goal: str = "", **changes) -> Inputs:
    number = now_ns // 100_000_000
    return Inputs((odometry(now_ns, x, number), driver(now_ns)), goal, **changes)
