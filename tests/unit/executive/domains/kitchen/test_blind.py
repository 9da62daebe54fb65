"""A robot that does not see: without pictures, or by pictures that cannot be true, it neither drives nor grips."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from tailor.executive import domains
from tailor.executive.core.modes import Mode
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import PERIOD_NS, Settings, make_context
from tailor.executive.domains.kitchen.action_library import GRIP_CUP
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain_results import measurement_fault
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.models.runtime import load_robot
from tailor.schemas.kitchen.furniture import kitchen
from tailor.schemas.messages.kitchen import ObjectPercept, ObjectPercepts
from tailor.simnodes.world import World
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.driver_link import DriverLink
from tailor.tools.lockstep.run import SENDER
from tests.unit.executive.domains.kitchen.test_phantoms import KITCHEN, believed, percept

GREEDY = Settings(refinement=dataclasses.replace(RefinementSettings(), horizon=1, certify_checks=0))
KEY = "b21/objects"
CUP = percept("cup1", 0.8)
TABLE = ObjectPercept("table1", *kitchen().tables["table1"][:2], 0.72, 0.0, 0.0, 1e-6, 1e-6, 1e-6)
STOOL = ObjectPercept("stool", 1.0, 0.0, 0.45, 0.0, 0.0, 1e-6, 1e-6, 1e-6)
HERE = believed(*[()] * 9)  # at the map's origin


def changed(thing, **fields):
    return dataclasses.replace(thing, **fields)


IMPOSSIBLE = [
    (changed(STOOL, x=-12.0, y=16.1), "has stool 20.0801 m away"),
    (changed(CUP, x=1e5), "has cup1 100000 m away"),
    (changed(CUP, z=3.1), "has cup1 at a height of 3.1 m"),
    (changed(CUP, z=-3.1), "has cup1 at a height of -3.1 m"),
    (changed(CUP, tilt=-6.3), "has cup1 tilted by -6.3 rad"),
    (changed(CUP, phi=6.3), "has cup1 turned by 6.3 rad"),
    (changed(TABLE, z=1.03), "has table1 at a height of 1.03 m"),
    (changed(TABLE, z=0.41), "has table1 at a height of 0.41 m"),
    (changed(TABLE, tilt=0.51), "has table1 tilted by 0.51 rad"),
    (changed(TABLE, phi=1e14), "has table1 turned by 1e+14 rad"),
    (changed(TABLE, y=TABLE.y + 1.06), "has table1 1.1 m from its place on the map"),
    (changed(STOOL, z=0.1), "has stool at a height of 0.1 m"),
    (changed(STOOL, tilt=-0.6), "has stool tilted by -0.6 rad"),
]
POSSIBLE = [
    changed(STOOL, x=-19.0, y=0.0),
    changed(CUP, z=2.9, phi=6.2, tilt=math.pi),
    changed(CUP, z=0.04, tilt=1.6),
    changed(TABLE, y=TABLE.y + 0.99, z=1.0, tilt=0.49),
    changed(STOOL, x=4.0, y=-2.0, z=0.2),
    percept("lamp", 2.0, 0.0, 1e14),
]


@pytest.mark.parametrize(("thing", "fault"), IMPOSSIBLE)
def test_a_picture_that_cannot_be_true_is_no_measurement_and_says_why(thing, fault):
    assert measurement_fault(KITCHEN, HERE, ObjectPercepts(0, (STOOL, thing))) == fault


@pytest.mark.parametrize("thing", POSSIBLE)
def test_whatever_can_be_is_believed(thing):
    assert measurement_fault(KITCHEN, HERE, ObjectPercepts(0, (thing,))) == ""


def test_while_the_robot_does_not_know_where_it_is_no_table_is_too_far():
    far = ObjectPercepts(0, (changed(TABLE, y=1.5),))
    assert measurement_fault(KITCHEN, believed(()), far) == ""
    assert measurement_fault(KITCHEN, HERE, far) != ""


def test_messages_of_other_sensors_are_not_judged():
    assert measurement_fault(KITCHEN, HERE, KITCHEN.message((0.1,) * len(KITCHEN.axes), 0)) == ""


def driven(spoiled, key=KEY, ticks=60, first=30):
    """States of a drive of scenario one-cup, whose samples of a key pass through `spoiled` in 20 ticks."""
    scenario, start = domains.seeded_scenario("kitchen", "one-cup", 3)
    context = make_context(KITCHEN, scenario, Models(*load_robot("b21")), GREEDY, SENDER)
    link = DriverLink(KITCHEN, World(body_of("kitchen", ""), start, 3), SENDER)
    state, states, goal = initial_state(context), [], context.problem.goal_text
    samples, _ = link.advance(0)
    for tick in range(1, ticks):
        now_ns = tick * PERIOD_NS
        kept = (spoiled(s) if s.key == key and first <= tick < first + 20 else s for s in samples)
        inputs, goal = Inputs(tuple(s for s in kept if s is not None), goal), ""
        state, outputs = step(context, state, now_ns, inputs, CheckBudget(300))
        states.append(state)
        link.send(outputs, now_ns, tick)
        samples, _ = link.advance(now_ns)
    return states


def with_a_wrong_table(sample):
    return dataclasses.replace(sample, message=ObjectPercepts(0, (changed(TABLE, phi=1e14),)))


@pytest.mark.promise("P6")
@pytest.mark.parametrize(
    ("spoiled", "detail"),
    [(lambda sample: None, "objects"), (with_a_wrong_table, "objects has table1 turned by 1e+14 rad")],
    ids=["no pictures", "wrong ones"],
)
def test_a_robot_that_does_not_see_stands_until_it_does(spoiled, detail):
    states = driven(spoiled)
    assert {s.mode for s in states[28:38]} == {Mode.EXECUTING}, "ten pictures may be lost"
    assert {s.mode for s in states[39:49]} == {Mode.HOLDING}
    assert {s.cause for s in states[39:49]} == {Cause(Reason.INPUT_STALE, detail)}
    assert all(s.command[:8] == (0.0,) * 8 for s in states[39:49])
    assert any(s.command[:2] != (0.0, 0.0) for s in states[28:38])
    assert states[-1].mode is Mode.EXECUTING
    assert all(abs(s.belief.thing("table1").phi) < 4.0 for s in states if s.belief.thing("table1") is not None)


def test_a_cup_that_was_never_seen_is_not_gripped():
    """It may be where the map has one, or beside it."""
    arguments = np.array([0.0, 0.0, 0.0, 0.75, 0.1, 0.0, 0.0, 0.0])
    blind = GRIP_CUP.controller(None, 0, believed(()), arguments)
    assert (blind.outcome, blind.detail) == ("failed", "no cup seen there")
    assert blind.command[:6] == (0.0,) * 6
    assert GRIP_CUP.controller(None, 0, believed([percept("cup1", 0.72, 0.12)]), arguments).outcome == "running"
