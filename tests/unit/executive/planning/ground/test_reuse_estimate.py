"""Which open conditions the estimate with reuse counts as achieved by a step of the plan."""

from tailor.executive.planning.ground_plans.flaw_measures import GroundFlawMeasures
from tailor.executive.planning.ground_plans.open_conditions import refine_open
from tailor.executive.planning.ground_plans.plan_estimates import GroundEstimates
from tailor.executive.planning.structures.linked_list import cells_of
from tests.support.planning.planning_problems import refined

DOMAIN = """(define (domain radio) (:predicates (on) (plugged) (reported) (sent))
  (:action plug :effect (plugged))
  (:action switch :precondition (plugged) :effect (on))
  (:action report :precondition (on) :effect {})
  (:action send :precondition (and (reported) (on)) :effect (sent)))"""
PROBLEM = "(define (problem p) (:domain radio) (:init) (:goal (sent)))"


def measured(effects):
    """Estimate, and steps of the conditions with an old achiever, where `report` (1) serves `send` (0)."""
    task, plan = refined(DOMAIN.format(effects), PROBLEM, 2)
    assert [step.name for step in plan.steps] == [("send",), ("report",)]
    measures = GroundFlawMeasures(task)
    reused = [measures.step(cell) for cell in cells_of(plan.open) if measures.has_old_achiever(plan, cell)]
    assert len(refine_open(task, plan, cells_of(plan.open)[1])) == 1  # by a new step only: a no-op achieves nothing
    return GroundEstimates(task).reusing(plan), reused


def test_an_effect_that_its_own_action_requires_counts_as_reusable_by_later_steps_alone():
    assert measured("(reported)") == ((4, 4), [])
    assert measured("(and (reported) (on))") == ((2, 3), [0])
