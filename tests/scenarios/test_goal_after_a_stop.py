"""AGILO is stopped on its way and armed again: it goes on with an open goal, and stands where that was dropped."""

from __future__ import annotations

import math

import pytest

from tailor.executive import domains
from tailor.executive.core.state import Inputs, initial_state
from tailor.executive.core.step import step
from tailor.executive.deliberation.context import PERIOD_NS, Settings, make_context
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.robot_models import load_models
from tailor.schemas.messages import ArmRequest, EStop, Sample
from tailor.simnodes.world import World
from tailor.tools.lockstep.bodies import body_of
from tailor.tools.lockstep.driver_link import DriverLink
from tailor.tools.lockstep.run import SENDER

PERSON = "bb" * 16
NOTHING = "(and)"  # a goal without conditions drops the open one
STOP, DROP, ARM, END = 40, 60, 70, 100  # periods


def driven(dropped: bool) -> tuple[list[float], str]:
    """Distance of each period, m, and the result of the task at the end."""
    scenario, start = domains.seeded_scenario("soccer", "approach-dribble", 3)
    context = make_context(domains.load("soccer"), scenario, load_models("agilo"), Settings(), SENDER)
    world = World(body_of("soccer", ""), start, 3, ())
    link, state = DriverLink(context.domain, world, SENDER), initial_state(context)
    samples, _ = link.advance(0)
    goals = {1: context.problem.goal_text, **({DROP: NOTHING} if dropped else {})}
    people = {STOP: ("estop", EStop(True)), ARM: ("arm_request", ArmRequest(True, True, SENDER, 0))}
    distances = []
    for period in range(1, END):
        now_ns = period * PERIOD_NS
        state, outputs = step(context, state, now_ns, Inputs(samples, goals.get(period, "")), CheckBudget(200))
        link.send(outputs, now_ns, period)
        if period in people:
            topic, message = people[period]
            link._driver.take([Sample(f"agilo/{topic}", message, now_ns, period, PERSON)], {}, now_ns)
        before = world.body.ground_truth()
        samples, _ = link.advance(now_ns)
        after = world.body.ground_truth()
        distances.append(math.hypot(after.x - before.x, after.y - before.y))
    assert link._driver.guard.mode == "armed"
    return distances, str(state.task.result or "")


@pytest.mark.promise("P41")
def test_a_robot_whose_goal_was_dropped_stands_after_people_armed_it(measured):
    distances, result = driven(dropped=True)
    assert sum(distances[:STOP]) > 0.3
    assert result == "cancelled"
    measured.add(sum(distances[DROP:]), limit=0.002, unit="m")


def test_a_robot_whose_goal_is_open_goes_on_when_people_arm_it():
    distances, _ = driven(dropped=False)
    assert sum(distances[DROP:ARM]) < 0.002
    assert sum(distances[ARM:]) > 0.3
