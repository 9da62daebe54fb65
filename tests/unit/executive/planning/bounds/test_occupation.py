"""How long a partial plan occupies exclusive facts: a lower bound on the makespan of whatever becomes of it."""

import pytest

from tailor.executive.planning.bounds.exclusive_facts import exclusive_facts
from tailor.executive.planning.bounds.occupation import Occupation
from tailor.executive.planning.ground_plans.open_conditions import refine_open
from tailor.executive.planning.plans.portions import completed_work
from tests.support.planning.planning_problems import refined

DOMAIN = """(define (domain visits) (:requirements :durative-actions)
  (:predicates (at ?r ?x) (seen ?x))
  (:durative-action go :parameters (?r ?x ?y) :duration (= ?duration 5)
    :condition (at start (at ?r ?x)) :effect (and (at start (not (at ?r ?x))) (at end (at ?r ?y))))
  (:durative-action look :parameters (?r ?x) :duration (= ?duration 7)
    :condition (over all (at ?r ?x)) :effect (at end (seen ?x))))"""
PROBLEM = """(define (problem p) (:domain visits) (:objects a h k m)
  (:init (at a h)) (:goal (and (seen k) (seen m))))"""


@pytest.fixture
def start():
    """The task, the bound in seconds, and the plan without steps."""
    task, plan = refined(DOMAIN, PROBLEM, 0)
    occupation = Occupation(task, completed_work(exclusive_facts(task)))
    assert occupation.applies
    return task, lambda plan: round(occupation.bound(plan) * task.grid.unit_s, 6), plan


def with_step(task, plan, name):
    """The plan in which a new step of that name supports the newest open condition."""
    children = refine_open(task, plan, plan.open)
    return next(c for c in children if len(c.steps) > len(plan.steps) and c.steps[-1].name == name)


def test_a_plan_without_steps_occupies_nothing(start):
    _, bound, plan = start
    assert bound(plan) == 0


def test_open_conditions_count_with_the_way_there(start):
    task, bound, plan = start
    look = with_step(task, plan, ("look", "a", "k"))
    assert bound(look) == 5 + 0.01 + 7


def test_links_count_with_the_steps_between_them(start):
    task, bound, plan = start
    gone = with_step(task, with_step(task, plan, ("look", "a", "k")), ("go", "a", "h", "k"))
    assert bound(gone) == 0.01 + 5 + 0.01 + 7  # at h a tick at least
    linked = refine_open(task, gone, gone.open)[-1]
    assert not linked.open.rest
    assert bound(linked) == 0.01 + 5 + 0.01 + 7


def test_visits_of_several_places_add_up_before_they_are_ordered(start):
    task, bound, plan = start
    gone = with_step(task, with_step(task, plan, ("look", "a", "k")), ("go", "a", "h", "k"))
    both = with_step(task, refine_open(task, gone, gone.open)[-1], ("look", "a", "m"))
    assert bound(both) == 2 * (0.01 + 5 + 7) + 0.01
    assert bound(both) > 1.4 * both.orderings.earliest()[1] * task.grid.unit_s


def test_what_an_action_s_own_start_makes_true_needs_no_time_before():
    hop = """(define (domain hops) (:requirements :durative-actions) (:predicates (at ?r ?x))
      (:durative-action hop :parameters (?r ?x ?y) :duration (= ?duration 5)
        :condition (and (at start (at ?r ?x)) (over all (at ?r ?y)))
        :effect (and (at start (not (at ?r ?x))) (at start (at ?r ?y)))))"""
    task, plan = refined(
        hop, "(define (problem p) (:domain hops) (:objects a h k) (:init (at a h)) (:goal (at a k)))", 0
    )
    occupation = Occupation(task, completed_work(exclusive_facts(task)))
    assert occupation.bound(with_step(task, plan, ("hop", "a", "h", "k"))) == task.grid.units(0.01 + 5)
