"""A robot on its way is no longer where it began, even if nothing but memory gives the place where it is."""

from __future__ import annotations

import pytest

from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.reasons import Reason
from tests.support.toy_domain import PDDL, PROBLEM, SENDER, LineDomain, LineModel, line_context
from tests.unit.executive.core.test_cancelled_goal import with_goals
from tests.unit.executive.core.test_core import drive

WAY_TO_A, WAY_TO_B = 6, 25  # ticks in which it slides there; a lies at 0.5 m, b at 1 m
PLACES = {"home": {"x": 0.0}, "a": {"x": 0.5}, "b": {"x": 1.5}}


def run_with(goals, ticks=80):
    """States and positions; the first goal leads over a to b."""
    return list(drive(line_context(places=PLACES), world=with_goals(goals), ticks=ticks))


@pytest.mark.parametrize(("tick", "goal"), [(WAY_TO_A, "(at home)"), (WAY_TO_B, "(at a)")])
def test_a_goal_to_be_where_an_action_began_is_not_achieved_on_the_way(tick, goal):
    run = run_with({tick: goal})
    assert abs(run[tick - 2][0].command[0]) > 0.1
    task = run[-1][0].task
    assert (task.goal, task.result) == (goal, "failed"), "no action of this robot leads from between two places"
    assert task.result_cause is not None
    assert task.result_cause.reason is Reason.UNSOLVABLE
    assert run[-1][0].command == (0.0,)


@pytest.mark.parametrize("goal", ["(at b)", "(visited a)", "(and (at a) (visited a))"])
def test_what_is_begun_goes_on_from_where_it_was_left(goal):
    run = run_with({WAY_TO_A: "(at home)", WAY_TO_A + 20: goal})
    state, _, x = run[-1]
    assert state.task.result == "achieved"
    assert x == pytest.approx(1.5 if goal == "(at b)" else 0.5, abs=0.06)


def test_a_place_is_where_the_robot_stands_before_it_begins_and_once_it_has_arrived():
    assert run_with({1: "(at home)"})[-1][0].task.result == "achieved"
    arrived = run_with({1: "(at a)", 40: "(at a)", 50: "(at home)"})
    assert arrived[42][0].task.result == "achieved"
    assert arrived[-1][0].task.result == "failed"


def test_what_happened_stays_so_on_the_way():
    run = run_with({WAY_TO_B: "(visited a)"})
    assert run[WAY_TO_B + 2][0].task.result == "achieved"


def test_a_robot_that_came_back_is_there():
    run = run_with({1: "(at a)", 30: "(at b)", 70: "(at a)"}, ticks=120)
    assert [run[tick][0].task.result for tick in (28, 68, -1)] == ["achieved"] * 3
    assert run[-1][2] == pytest.approx(0.5, abs=0.06)


class Rover(LineDomain):
    """The toy robot, whose way to a place may begin anywhere."""

    pddl = PDDL.replace("(at ?from) (place ?to)", "(place ?from) (place ?to)")


@pytest.mark.parametrize("tick", [WAY_TO_B, WAY_TO_B + 3])
def test_a_robot_that_can_turns_back_to_the_place_that_it_has_left(tick):
    scenario, models = Scenario("two-places", PROBLEM, PLACES), Models({"slide/duration": LineModel()}, {})
    context = make_context(Rover(), scenario, models, Settings(), SENDER)
    run = list(
        drive(context, world=with_goals({1: "(at a)", 18: "(and (at b) (not (at a)))", tick: "(at a)"}), ticks=80)
    )
    assert run[tick - 2][2] > 0.6
    assert run[tick + 2][0].command[0] < -0.1
    assert run[-1][0].task.result == "achieved"
    assert run[-1][2] == pytest.approx(0.5, abs=0.06)
