"""A goal of thousands of literals costs a tick little: it is read once, and each literal is achieved once."""

from tailor.executive.planning.ground.ground_task import make_task
from tailor.executive.planning.ground.grounding import ground_actions, static_world
from tailor.executive.planning.pddl import problem as problems
from tailor.executive.planning.plans.portions import completed_work
from tests.support.planning.planning_problems import read

DOMAIN = """(define (domain d) (:predicates (lit ?l))
  (:action switch :parameters (?l) :precondition () :effect (lit ?l)))"""
PROBLEM = "(define (problem p) (:domain d) (:objects a b) (:init) (:goal (lit a)))"


def test_a_literal_that_is_repeated_is_one_condition_of_the_goal():
    _, problem = read(DOMAIN, PROBLEM)
    goal = "(and " + "(lit b) (lit a) (or (lit a) (lit b)) (or (lit b) (lit a) (lit b)) " * 100 + ")"
    *_, grounded = ground_actions(problem, static_world(problem), 0.01, 10_000)
    task = completed_work(make_task(problem.with_goal(goal), grounded))
    b, a = (task.names[number] for number in task.goal[:2])
    assert (b.fact, a.fact) == (("lit", "b"), ("lit", "a"))
    assert len(task.goal) == 4  # the disjunctions differ in their order, which the search keeps


def test_a_goal_is_read_once_whatever_facts_it_is_pursued_from(monkeypatch):
    _, problem = read(DOMAIN, PROBLEM)
    texts, read_form = [], problems.read_form
    monkeypatch.setattr(problems, "read_form", lambda text, source: texts.append(text) or read_form(text, source))
    first, other = "(and (lit a) (lit b))", "(lit b)"
    begun = problem.with_goal(first)
    later = problem.with_initial([("lit", "a")]).with_goal(first)
    assert (later.goal, later.goal_text, later.initial) == (begun.goal, first, (("lit", "a"),))
    assert texts == [first]
    assert problem.with_goal(other).goal != begun.goal
    assert problem.with_goal(first) == begun
    assert texts == [first, other, first]  # the newest alone is kept
