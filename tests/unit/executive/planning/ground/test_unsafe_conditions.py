"""Which open conditions the flaw criterion `u` selects."""

import pytest

from tailor.executive.planning.ground_plans.flaw_measures import GroundFlawMeasures
from tailor.executive.planning.structures.linked_list import cells_of
from tests.support.planning.planning_problems import refined

DOMAIN = """(define (domain radio) (:predicates (free) (reported) (sent))
  (:action report :precondition (free) :effect (and {} (reported)))
  (:action send :precondition (and (reported) (free)) :effect (sent)))"""
PROBLEM = "(define (problem p) (:domain radio) (:init (free)) (:goal (sent)))"


def unsafe_conditions(effects):
    """Steps of the unsafe conditions of the plan in which `send` (0) has its condition from `report` (1)."""
    task, plan = refined(DOMAIN.format(effects), PROBLEM, 2)
    assert [step.name for step in plan.steps] == [("send",), ("report",)]
    measures = GroundFlawMeasures(task)
    return [measures.step(condition) for condition in cells_of(plan.open) if measures.is_unsafe(plan, condition)]


@pytest.mark.parametrize(
    ("effects", "unsafe"),
    [("", []), ("(not (free))", [0]), ("(not (free)) (free)", [0])],
    ids=["untouched", "deleted", "deleted and restored"],
)
def test_a_condition_is_unsafe_beside_a_step_that_deletes_it_even_if_it_restores_it_at_once(effects, unsafe):
    assert unsafe_conditions(effects) == unsafe
