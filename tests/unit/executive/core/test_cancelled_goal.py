"""A goal without conditions drops the open one: armed or not, the robot stands until another goal is set.

That goal begins with the facts which the one before has left, not with those of the scenario.
"""

from __future__ import annotations

import dataclasses

import pytest

from tailor.executive.core.modes import Mode
from tailor.executive.core.state import Inputs
from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.interfaces.models import Models
from tailor.schemas.messages import ActionFinished, ArmRequest, ExecStatus
from tests.support.toy_domain import SENDER, LineDomain, LineModel, driver, line_context, odometry
from tests.unit.executive.core.test_core import GOAL, TICK, drive, messages


def with_goals(goals, disarmed=()):
    """A world in which further goals are set, by tick, and the driver is disarmed for some ticks."""

    def world(n, given, x):
        mode = "disarmed" if n in disarmed else "armed"
        return Inputs((odometry(n * TICK, x, n), driver(n * TICK, mode)), goals.get(n, given.goal))

    return world


@pytest.mark.promise("P41")
def test_an_armed_robot_brakes_in_that_tick_and_its_goal_is_reported_as_cancelled():
    run = list(drive(line_context(), world=with_goals({6: "(and)"}), ticks=30))
    assert run[4][0].command[0] > 0.1
    assert [state.command[0] for state, _, _ in run[5:]] == [0.0] * 25
    assert {(s.mode, s.goal, s.result) for s in messages(run[5:], ExecStatus)} == {("READY", GOAL, "cancelled")}
    assert messages(run, ArmRequest) == [], "it stays armed"


@pytest.mark.promise("P41")
def test_a_robot_that_is_disarmed_when_its_goal_is_dropped_stands_once_it_is_armed():
    run = list(drive(line_context(), world=with_goals({8: "()"}, disarmed=range(6, 12)), ticks=40))
    assert run[4][0].command[0] > 0.1
    assert {state.command[0] for state, _, _ in run[11:]} == {0.0}
    assert run[-1][0].mode is Mode.READY


def test_another_goal_moves_it_again():
    run = list(drive(line_context(), world=with_goals({6: "(and)", 9: GOAL}), ticks=60))
    assert run[-1][0].task.result == "achieved"


def test_what_is_over_already_keeps_its_result():
    run = list(drive(line_context(), world=with_goals({80: "(and)"}), ticks=90))
    assert run[78][0].task.result == "achieved"
    assert run[-1][0].task == run[78][0].task


@pytest.mark.parametrize("goal", ["(and)", ""])
def test_it_ends_a_fault(goal):
    def world(n, given, x):
        return dataclasses.replace(given, goal=goal if n == 20 else given.goal)

    run = list(
        drive(line_context(places={"home": {"x": 0.0}, "a": {"x": 95.0}, "b": {"x": 1.0}}), world=world, ticks=30)
    )
    assert run[18][0].mode is Mode.FAULT
    assert run[-1][0].mode is (Mode.READY if goal else Mode.FAULT)


DONE = "(not (dirty a))"
PLACES = {"home": {"x": 0.0}, "a": {"x": 0.5}}
PROBLEM = f"(define (problem room) (:domain mop) (:objects home a) (:init (dirty a)) (:goal {DONE}))"


class Mop(LineDomain):
    """The toy robot, which mops: once it has done so, no fact holds."""

    pddl = """
    (define (domain mop)
      (:predicates (dirty ?p))
      (:action slide :parameters (?from ?to) :precondition (dirty ?to) :effect (not (dirty ?to))))
    """


def test_a_goal_that_the_last_one_has_brought_about_is_achieved_though_no_fact_holds():
    scenario, models = Scenario("room", PROBLEM, PLACES), Models({"slide/duration": LineModel()}, {})
    context = make_context(Mop(), scenario, models, Settings(), SENDER)
    again = 60

    def world(n, given, _):
        return dataclasses.replace(given, goal=DONE if n in (1, again) else "")

    run = list(drive(context, world=world, ticks=again + 5))
    states = [state for state, _, _ in run]
    assert (states[again - 2].task.result, states[again - 2].task.facts) == ("achieved", frozenset())
    assert len(messages(run, ActionFinished)) == 1
    assert states[-1].task.result == "achieved"
