"""Exchange with an external planner: problems written as PDDL, and plans whose links are completed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive import domains
from tailor.executive.planning import (
    Link,
    Literal,
    completed,
    format_links,
    format_plan,
    format_problem,
    parse_domain,
    parse_plan,
    parse_problem,
    validate,
    validate_every_order,
)
from tailor.executive.planning.plans.portions import completed_work
from tailor.executive.planning.semantics.links import linking
from tailor.executive.planning.semantics.state import Objects
from tailor.schemas.installed import domain_names
from tests.support.planning.planning_problems import DATA, OWN, own, printed, read, solve

RICH_DOMAIN = """(define (domain rich) (:requirements :typing :fluents :timed-initial-literals :durative-actions)
  (:types cup plate - thing robot) (:constants dock - object)
  (:predicates (open ?x) (washed ?t - thing)) (:functions (time-for ?t - thing))
  (:durative-action wash :parameters (?t - thing) :duration (= ?duration (time-for ?t))
    :condition (over all (open dock)) :effect (at end (washed ?t))))"""
RICH_PROBLEM = """(define (problem much) (:domain rich)
  (:objects c - cup x - (either cup plate) r - robot y)
  (:init (open dock) (= (time-for c) 2.25) (= (time-for x) 3) (at 50.5 (not (open dock))) (at 60 (open dock)))
  (:goal (and (washed c) (not (washed x)) (exists (?t - thing) (washed ?t)))) (:metric minimize (total-time)))"""


@pytest.mark.parametrize("name", OWN)
def test_a_problem_reads_back_as_itself(name):
    domain, problem = own(name)
    assert parse_problem(format_problem(problem), domain) == problem


def test_types_values_timed_literals_and_the_metric_are_written_too():
    domain, problem = read(RICH_DOMAIN, RICH_PROBLEM)
    assert len(problem.timed) == 2
    assert parse_problem(format_problem(problem), domain) == problem


@pytest.mark.parametrize("number", ["1e-10", "0.12345678901234", "987654321.123456", "-2.5e-7", "1e9", "0"])
def test_numbers_are_written_with_all_their_decimals(number):
    domain, problem = read(RICH_DOMAIN, RICH_PROBLEM.replace("2.25", number).replace("50.5", "3.0000000012"))
    assert "e" not in format_problem(problem).partition("time-for c)")[2].partition(")")[0]
    assert parse_problem(format_problem(problem), domain) == problem


def test_a_goal_with_comments_is_written_without_them():
    domain, problem = read(RICH_DOMAIN, RICH_PROBLEM)
    asked = problem.with_goal("(and (washed c) ; the cup\n (open dock)) ; and no more")
    assert asked.goal_text == "(and (washed c) (open dock))"
    assert parse_problem(format_problem(asked), domain) == asked


@pytest.mark.parametrize("name", domain_names())
def test_every_scenario_of_every_domain_can_be_asked(name):
    loaded = domains.load(name)
    domain = parse_domain(loaded.pddl)
    for scenario in domains.scenarios(name)[:8]:
        problem = parse_problem(domains.seeded_scenario(name, scenario, 0)[0].problem, domain)
        assert parse_problem(format_problem(problem), domain) == problem


@pytest.mark.parametrize("name", [name for name in OWN if "durative" not in name])
def test_a_plain_plan_gets_a_sound_link_for_every_condition(name):
    domain, problem = own(name)
    whole = solve(domain, problem).plan
    linked = completed(parse_plan(format_plan(whole)), domain, problem)
    assert validate(linked, domain, problem) == ""
    assert supported(linked) == supported(whole)


def supported(plan):
    """What each action has a link for; the plain form numbers its steps anew."""
    actions = {step.id: step.action for step in plan.steps}
    return {(link.literal, actions.get(link.consumer)) for link in plan.links}


def test_links_from_static_facts_are_added_and_the_planners_own_stand():
    loaded = domains.load("soccer")
    domain = parse_domain(loaded.pddl)
    problem = parse_problem(domains.seeded_scenario("soccer", "waypoints", 0)[0].problem, domain)
    whole = solve(domain, problem).plan
    changing = {effect.atom.predicate for action in domain.actions for effect in action.effects}
    static = [link for link in whole.links if link.literal.fact[0] not in changing]
    assert static, "else this test proves nothing"
    bare = replace(whole, links=tuple(link for link in whole.links if link not in static))
    linked = completed(parse_plan(format_links(bare)), domain, problem)
    assert set(linked.links) == set(whole.links)
    assert linked.orderings == whole.orderings
    assert linked.initial == problem.initial


@pytest.mark.parametrize("path", sorted((DATA / "vhpop-output").glob("*.txt")), ids=lambda path: path.stem)
def test_every_plan_that_the_original_printed_is_believed_keeps_its_links_and_gets_those_that_it_lacks(path):
    domain, problem = own(path.name.split(".")[0])
    plan = parse_plan(path.read_text())
    linked = completed(plan, domain, problem)
    assert validate(linked, domain, problem) == ""
    assert set(plan.links) <= set(linked.links)
    needed = completed_work(linking(replace(linked, links=()), domain, Objects(problem)))
    assert {(x.literal, x.consumer) for x in needed} <= {(x.literal, x.consumer) for x in linked.links}


def test_a_link_that_is_neither_there_nor_static_makes_all_of_them_anew():
    domain, problem = own("kitchen-s1")
    whole = parse_plan(printed("kitchen-s1.ground.links"))
    linked = completed(replace(whole, links=whole.links[1:]), domain, problem)
    assert {(x.literal, x.consumer) for x in linked.links} >= {(x.literal, x.consumer) for x in whole.links}
    assert validate(linked, domain, problem) == ""


def test_orderings_that_the_links_require_are_added():
    domain, problem = read(
        """(define (domain d) (:predicates (p) (q)) (:action make :parameters () :effect (p))
        (:action undo :parameters () :effect (and (q) (not (p)))))""",
        "(define (problem x) (:domain d) (:init) (:goal (and (p) (q))))",
    )
    text = "Step 1 : (undo)\nStep 2 : (make)\nGoal :\n  1 -> (q)\n  2 -> (p)\norderings = {{{}}}\n"
    for printed_orderings in ("", " 1<2 "):
        linked = completed(parse_plan(text.format(printed_orderings)), domain, problem)
        assert linked.orderings == ((1, 2),)
        assert validate_every_order(linked, domain, problem) == ""


def test_an_unsound_plan_stays_out_and_the_reason_is_told():
    domain, problem = own("kitchen-s1")
    whole = parse_plan(printed("kitchen-s1.ground.links"))
    assert "lacks a condition" in completed(replace(whole, steps=whole.steps[1:], links=()), domain, problem)
    wrong = Link(0, Literal(("holding", "r1", "cup1")), whole.steps[0].id)
    assert "causal link" in completed(replace(whole, links=(*whole.links, wrong)), domain, problem)


@pytest.mark.parametrize("name", [name for name in OWN if "durative" in name])
def test_the_times_of_a_plan_in_plain_form_outlive_its_links(name):
    domain, problem = own(name)
    plain = parse_plan(format_plan(solve(domain, problem).plan))
    plan = completed(plain, domain, problem)
    back = parse_plan(format_links(plan))
    assert back.steps == plain.steps
    assert set(plan.orderings) <= set(back.orderings)
    assert validate(back, domain, problem) == ""
