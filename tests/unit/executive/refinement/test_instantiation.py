"""Instantiation gives the paper's worked example (Figure 10, Algorithm 2 line 14), or fails with a reason."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain import Conflict
from tailor.executive.interfaces.values import Interval
from tailor.executive.planning import Link, Literal, Plan, Search, parse_domain, parse_problem
from tailor.executive.refinement.instantiation import instantiate
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tests.support.synthetic_models import LIBRARY, PI

DOMAIN = """
(define (domain soccer) (:requirements :strips) (:predicates (robot ?p) (ball ?p) (atball ?p) (final ?p))
  (:action approachball :parameters (?from ?to) :precondition (and (robot ?from) (ball ?to))
    :effect (and (not (robot ?from)) (robot ?to) (atball ?to)))
  (:action dribbleball :parameters (?from ?to) :precondition (atball ?from)
    :effect (and (not (atball ?from)) (not (ball ?from)) (atball ?to) (ball ?to))))
"""
PROBLEM = """
(define (problem figure-10) (:domain soccer) (:objects pos1 pos2 pos3)
  (:init (robot pos1) (ball pos2) (final pos3)) (:goal (and (final pos3) (atball pos3))))
"""
KNOWN = {
    "robot": {"x": 0.0, "y": 1.0, "phi": 0.0, "v": 0.0},
    "ball": {"x": 3.0, "y": 1.0},
    "final": {"x": 1.0, "y": 3.0, "phi": 2.6, "v": 0.0},
}


@dataclass
class PaperDomain:
    """Values as in the comments of Algorithm 2; atball limits the speed to 0..0.3 m/s."""

    actions: dict[str, Any] = field(default_factory=lambda: dict(LIBRARY))
    executables: dict[str, str] = field(
        default_factory=lambda: {"approachball": "approachBall", "dribbleball": "dribbleBall"}
    )
    queries: list[Any] = field(default_factory=list)

    def value(self, query):
        quantity = query.quantity
        self.queries.append((query.label, query.holds, query.achieved))
        values = [KNOWN[fact[0]][quantity] for fact in query.holds if quantity in KNOWN[fact[0]]]
        if len(set(values)) > 1:
            raise Conflict(f"{quantity} of {query.label} cannot be {values}")
        if values:
            return Interval(values[0], values[0])
        if quantity == "v" and any(fact[0] == "atball" for fact in query.achieved):
            return Interval(0.0, 0.3)
        return None


def paper_plan(extra: tuple[Link, ...] = ()) -> Plan:
    """The plan of Figure 10, as our own planner finds it, with `extra` links added."""
    result = Search(parse_domain(DOMAIN), parse_problem(PROBLEM, parse_domain(DOMAIN))).advance(CheckBudget(100))
    assert result is not None
    return replace(result.plan, links=result.plan.links + extra)


def instantiated() -> ActionSequence:
    sequence = instantiate(paper_plan(), PaperDomain(), None, None)
    assert isinstance(sequence, ActionSequence)
    return sequence


def test_worked_example_binds_and_frees_the_parameters_as_in_the_paper():
    sequence = instantiated()
    ranges = [
        [
            (sequence.variables[i].value,) if sequence.variables[i].value is not None
            else (sequence.variables[i].lower, sequence.variables[i].upper)
            for i in action.variables
        ]
        for action in sequence.actions
    ]  # fmt: skip
    assert [action.action.name for action in sequence.actions] == ["approachBall", "dribbleBall"]
    assert ranges[0] == [(0.0,), (1.0,), (0.0,), (0.0,), (3.0,), (1.0,), (-PI, PI), (0.0, 0.3)]
    assert ranges[1] == [(3.0,), (1.0,), (-PI, PI), (0.0, 0.3), (1.0,), (3.0,), (2.6,), (0.0,)]


def test_shared_label_and_quantity_is_one_variable():
    sequence = instantiated()
    approach, dribble = sequence.actions
    assert approach.variables[4:] == dribble.variables[:4]
    assert [variable.id for variable in sequence.variables] == list(range(12))
    assert {variable.quantity for variable in sequence.free()} == {"phi", "v"}


def test_domain_is_queried_with_the_causal_links_of_the_label():
    domain = PaperDomain()
    instantiate(paper_plan(), domain, None, None)
    queries = {label: (holds, achieved) for label, holds, achieved in domain.queries}
    assert queries["pos2"] == ((("ball", "pos2"),), (("atball", "pos2"),))
    assert queries["pos3"] == ((("final", "pos3"),), (("atball", "pos3"),))


def test_contradicting_predicates_fail_with_the_step_and_the_reason():
    plan = paper_plan((Link(0, Literal(("final", "pos2")), 1),))
    failure = instantiate(plan, PaperDomain(), None, None)
    assert isinstance(failure, Failure)
    assert "approachball pos1 pos2" in failure.reason
    assert "x of pos2" in failure.reason


def test_range_outside_the_parameters_range_fails():
    class TooFast(PaperDomain):
        def value(self, query):
            interval = super().value(query)
            return Interval(1.0, 2.0) if (query.quantity, query.label) == ("v", "pos2") else interval

    failure = instantiate(paper_plan(), TooFast(), None, None)
    assert isinstance(failure, Failure)
    assert "v of pos2" in failure.reason


@pytest.mark.parametrize(("lower", "upper", "wraps"), [(-PI, PI, True), (2.5, 3.5, False), (-10.0, 10.0, True)])
def test_angle_wraps_only_when_the_whole_turn_is_free(lower, upper, wraps):
    class Sector(PaperDomain):
        def value(self, query):
            interval = super().value(query)
            return Interval(lower, upper) if (query.quantity, query.label) == ("phi", "pos2") else interval

    sequence = instantiate(paper_plan(), Sector(), None, None)
    assert isinstance(sequence, ActionSequence)
    angle = next(variable for variable in sequence.free() if variable.quantity == "phi")
    assert angle.periodic is wraps
    assert (angle.lower, angle.upper) == ((-PI, PI) if wraps else (lower, upper))


def test_binding_keeps_bound_variables_and_other_ids():
    sequence = instantiated()
    free = sequence.free()[0]
    bound = sequence.bind({free.id: 0.5, 0: 9.0})
    assert bound.variables[free.id].value == 0.5
    assert bound.variables[0].value == 0.0


def test_negative_link_restricts_no_value():
    domain = PaperDomain()
    instantiate(paper_plan((Link(0, Literal(("robot", "pos2"), positive=False), 1),)), domain, None, None)
    assert ("robot", "pos2") not in {fact for _, holds, _ in domain.queries for fact in holds}
