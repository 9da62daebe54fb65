"""A goal begins with the abstract state that the one before has left, not with that of the scenario."""

from __future__ import annotations

import dataclasses

from tailor.executive.deliberation.context import Settings, make_context
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.interfaces.models import Models
from tailor.schemas.messages import ActionFinished
from tests.support.toy_domain import SENDER, LineDomain, LineModel
from tests.unit.executive.core.test_core import drive, messages

GOAL = "(not (dirty a))"
PLACES = {"home": {"x": 0.0}, "a": {"x": 0.5}}
PROBLEM = f"(define (problem room) (:domain mop) (:objects home a) (:init (dirty a)) (:goal {GOAL}))"


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
        return dataclasses.replace(given, goal=GOAL if n in (1, again) else "")

    run = list(drive(context, world=world, ticks=again + 5))
    states = [state for state, _, _ in run]
    assert (states[again - 2].task.result, states[again - 2].task.facts) == ("achieved", frozenset())
    assert len(messages(run, ActionFinished)) == 1
    assert states[-1].task.result == "achieved"
