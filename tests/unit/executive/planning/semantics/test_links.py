"""Plans without links get them: for conditions, for conditional effects, and for those that must not happen."""

import dataclasses
import time

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tailor.executive.planning import GOAL, Settings, parse_plan, relink, suffix, validate
from tests.property.test_planning_soundness import LITERALS, VARIABLE_LITERALS, conjunction, problems
from tests.support.planning.planning_problems import read, solve
from tests.unit.executive.planning.pddl.test_language import LAMPS, SWITCHES, TIMED, WORKSHOP


def lamps(goal, effect):
    domain = SWITCHES.replace("{unlock}", "(done)").replace("{finish}", "()").replace("{effect}", effect)
    return read(domain, LAMPS.replace("{goal}", goal))


def linked(text, domain, problem):
    """The links of a plan in plain form, as (producer, literal, consumer), and its orderings."""
    plan = relink(parse_plan(text), domain, problem)
    assert validate(plan, domain, problem) == ""
    return {(link.producer, str(link.literal), link.consumer) for link in plan.links}, set(plan.orderings)


def test_the_condition_of_a_conditional_effect_is_linked_to_its_step():
    task = lamps("(open hall)", "(when (on a) (open hall))")
    links, orderings = linked("1:(press a)\n2:(finish)\n", *task)
    assert links == {(0, "(not (on a))", 1), (1, "(on a)", 2), (2, "(open hall)", GOAL)}
    assert orderings == {(1, 2)}


def test_a_conditional_effect_that_nobody_needs_has_no_links():
    links, orderings = linked("1:(press a)\n2:(finish)\n", *lamps("(done)", "(and (done) (when (on a) (open hall)))"))
    assert links == {(0, "(not (on a))", 1), (2, "(done)", GOAL)}
    assert orderings == set()


def test_conditions_are_followed_from_effect_to_effect():
    task = lamps("(open hall)", "(and (when (on a) (done)) (when (done) (open hall)))")
    links, orderings = linked("1:(press a)\n2:(finish)\n3:(finish)\n", *task)
    assert {(1, "(on a)", 2), (2, "(done)", 3), (3, "(open hall)", GOAL)} <= links
    assert orderings == {(1, 2), (1, 3), (2, 3)}


def test_what_keeps_a_conditional_effect_from_breaking_a_link_is_linked_too():
    # finish switches a off when b is on: b is pressed after it
    task = lamps("(and (done) (on a) (on b))", "(and (done) (when (on b) (not (on a))))")
    links, orderings = linked("1:(press a)\n2:(finish)\n3:(press b)\n", *task)
    assert (0, "(not (on b))", 2) in links
    assert (2, 3) in orderings


def test_what_keeps_an_action_from_adding_again_what_it_deletes_is_linked_too():
    # finish switches b off, unless a is off: a is pressed before it
    task = lamps("(not (on b))", "(and (not (on b)) (when (not (on a)) (on b)))")
    links, orderings = linked("1:(press a)\n2:(press b)\n3:(finish)\n", *task)
    assert {(1, "(on a)", 3), (3, "(not (on b))", GOAL)} <= links
    assert (1, 3) in orderings


def test_an_effect_at_the_end_is_linked_to_what_it_needs_at_the_start():
    domain = """
    (define (domain kiln) (:requirements :adl :durative-actions) (:predicates (lit) (clay) (ash))
      (:durative-action light :parameters () :duration (= ?duration 1) :effect (at end (lit)))
      (:durative-action fire :parameters () :duration (= ?duration 5)
        :effect (and (at start (not (clay))) (when (at start (and (lit) (clay))) (at end (ash))))))"""
    task = read(domain, "(define (problem p) (:domain kiln) (:init (clay)) (:goal (ash)))")
    links, _ = linked("0.01:(light)[1]\n2:(fire)[5]\n", *task)
    assert links == {(1, "(lit)", 2), (0, "(clay)", 2), (2, "(ash)", GOAL)}


def test_timed_literals_support_what_comes_after_them():
    links, _ = linked("4:(forge a)[3]\n", *read(WORKSHOP, TIMED))
    assert links == {(0, "(hot a)", 1), (0, "(light)", 1), (1, "(shaped a)", GOAL)}


def test_the_suffix_of_a_plan_keeps_the_conditions_of_conditional_effects():
    domain, problem = lamps("(open hall)", "(when (on a) (open hall))")
    plan = solve(domain, problem).plan
    press = next(step.id for step in plan.steps if step.action[0] == "press")
    rest = suffix(plan, {press}, domain, problem.with_initial([*problem.initial, ("on", "a")]))
    assert [(link.producer, str(link.literal)) for link in rest.links if link.consumer != GOAL] == [(0, "(on a)")]


WHEN = st.lists(st.builds("(when {} {})".format, VARIABLE_LITERALS, VARIABLE_LITERALS), min_size=1, max_size=3)


@settings(max_examples=100, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(problems(st.just("()"), WHEN, st.lists(LITERALS, min_size=2, max_size=3).map(conjunction)))
def test_whatever_keeps_to_the_orderings_of_a_linked_plan_reaches_the_goal(texts):
    domain, problem = read(*texts)
    plan = solve(domain, problem, Settings(node_limit=200)).plan
    if plan is None:
        return
    plan = relink(dataclasses.replace(plan, links=(), orderings=()), domain, problem)
    late_first = []  # another order: of the steps that may come next always the one that stands last
    left = list(plan.steps)
    while left:
        ids = {step.id for step in left}
        ready = [s for s in left if not any(i in ids and j == s.id for i, j in plan.orderings)]
        late_first.append(ready[-1])
        left.remove(ready[-1])
    steps = tuple(dataclasses.replace(step, start=float(n)) for n, step in enumerate(late_first, 1))
    assert validate(dataclasses.replace(plan, steps=steps), domain, problem) == ""


def test_a_condition_that_the_first_of_millions_of_objects_fulfils_is_linked_at_once():
    objects = " ".join(f"o{n}" for n in range(10))
    domain, problem = read(
        """(define (domain d) (:predicates (p ?x) (g)) (:action a :parameters ()
          :precondition (exists (?a ?b ?c ?d ?e ?f ?i ?j) (p ?a)) :effect (g)))""",
        f"(define (problem x) (:domain d) (:objects {objects}) (:init (p o0)) (:goal (g)))",
    )
    began = time.process_time()
    links, _ = linked("1:(a)\n", domain, problem)
    assert time.process_time() - began < 5
    assert links == {(0, "(p o0)", 1), (1, "(g)", GOAL)}
