"""Plans as text: writing and reading VHPOP's forms; bad text is rejected with its line."""

import time

import pytest

from tailor.executive.planning import (
    GOAL,
    Link,
    Literal,
    PlanTextError,
    Settings,
    completed,
    format_links,
    format_plan,
    number_of_steps,
    parse_plan,
    validate,
)
from tests.support.planning.planning_problems import OWN, own, printed, read, solve

FIGURE_10 = """Initial 0 : (robot pos1) (ball pos2) (final pos3)

Step 2   : (approachball pos1 pos2)
          0  -> (ball pos2)
          0  -> (robot pos1)

Step 1   : (dribbleball pos2 pos3)
          2  -> (atball pos2)

Goal     :
          0  -> (final pos3)
          1  -> (atball pos3)
"""


@pytest.mark.parametrize("name", OWN)
def test_what_is_written_is_read_back_as_the_same_plan(name):
    plan = solve(*own(name)).plan
    assert parse_plan(format_links(plan)) == plan


def test_plain_form_keeps_times_and_durations():
    plan = parse_plan(format_plan(solve(*own("soccer-durative-p1")).plan))
    assert [(step.start, step.duration) for step in plan.steps] == [(0.01, 3), (3.02, 1), (4.03, 5), (9.04, 5)]
    assert plan.durative


def test_the_papers_figure_10_is_read():
    plan = parse_plan(FIGURE_10 + "orderings = { 2<1 }\n")
    assert plan.initial == (("robot", "pos1"), ("ball", "pos2"), ("final", "pos3"))
    assert [step.action for step in plan.steps] == [("approachball", "pos1", "pos2"), ("dribbleball", "pos2", "pos3")]
    assert plan.links_to(1) == (Link(2, Literal(("atball", "pos2")), 1),)
    assert plan.links_to(GOAL)[0] == Link(0, Literal(("final", "pos3")), GOAL)


def test_lifted_plan_prints_its_bindings_as_the_original_does():
    plan = solve(*own("soccer-p1"), Settings(ground=False)).plan
    assert format_links(plan) == printed("soccer-p1.lifted.links")


def test_negated_literals_survive():
    text = ";p\nInitial  : (a)\n\nGoal     : \n          0   -> (not (b x))\norderings = { }\n"
    plan = parse_plan(text)
    assert plan.links == (Link(0, Literal(("b", "x"), False), GOAL),)
    assert format_links(plan) == text


def test_an_empty_plan_has_a_goal_and_nothing_else():
    assert parse_plan(";p\nInitial  : (a)\n\nGoal     : \norderings = { }\n").steps == ()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "there is no plan"),
        (";p\nno plan\n", "line 2: expected a step"),
        (";p\n1:(move a b\n", "line 2: expected a step"),
        ("Step 1   : (a)\nStep 1   : (b)\nGoal     : \n", "line 2: step 1 is given twice"),
        ("          0   -> (a)\n", "line 1: a causal link before any step"),
        ("Step 1   : (a)\n          7   -> (b)\nGoal     : \n", "7 and 1 are linked or ordered"),
        ("Step 1   : (a)\nStep 2   : (b)\nGoal     : \norderings = { 1<2 2<1 }\n", "cycle"),
        ("Step 1   : (a)\nGoal     : \norderings = \n  0 inf\n", "expected a 3 x 3 table"),
        ("x" * 2_000_000, "longer than"),
        ("1:(a)\n" * 201 + "then a line that nobody reads", "more than 200 steps"),
        ("orderings 1<2\n" + "0 " * 402 + "x", "line 2: a table of orderings for more than 200 steps"),
        ("orderings 1<2\n" + "0\n" * 402 + "x", "line 403: a table of orderings for more than 200 steps"),
        ("Step 1   : (a)\nGoal     : \norderings = \n  0\ntolerance = soon\n", "line 5: expected a time, found 'soon'"),
        ("Goal     : \norderings = \n  0\n(define x)\n", "line 4: expected a whole number, found '(define'"),
    ],
)
def test_bad_text_is_refused_with_its_line(text, message):
    with pytest.raises(PlanTextError) as caught:
        parse_plan(text)
    assert message in str(caught.value)


@pytest.mark.promise("P8")
def test_a_long_number_among_the_orderings_is_read_in_no_time():
    """An executive reads an answer within a tick; one of 128 KiB in a single number took minutes."""
    began_s = time.process_time()
    with pytest.raises(PlanTextError, match="there is no plan"):
        parse_plan("orderings " + "1" * 20_000)
    assert time.process_time() - began_s < 1.0  # it takes milliseconds; from every digit on, seconds


def test_orderings_are_read_as_pairs():
    links = "Step 1 : (a)\nStep 2 : (b)\nStep 12 : (c)\nGoal :\norderings = { 1<2 2<12 }"
    assert parse_plan(links).orderings == ((1, 2), (2, 12))


def test_a_sequence_of_actions_is_a_plan():
    plan = parse_plan("; cost = 2\n(navigate dock table1)\n(grip cup1 table1)\n")
    assert [(step.id, step.action, step.start) for step in plan.steps] == [
        (1, ("navigate", "dock", "table1"), 1.0),
        (2, ("grip", "cup1", "table1"), 2.0),
    ]


def test_the_competitions_timed_form_is_a_plan():
    plan = parse_plan("0.001: (navigate dock table1) [2.5]\n2.502: (grip cup1 table1) [1.0]\n")
    assert [(step.start, step.duration) for step in plan.steps] == [(0.001, 2.5), (2.502, 1.0)]
    assert plan.durative


INSTANT = """(define (domain d) (:requirements :durative-actions) (:predicates (p) (q) (g))
  (:durative-action a :parameters () :duration (= ?duration 1) :condition {} :effect (at end (p)))
  (:action b :parameters () :precondition (p) :effect (q))
  (:durative-action c :parameters () :duration (= ?duration 1) :condition (at start (q)) :effect (at end (g))))"""
DONE = "(define (problem x) (:domain d) (:init) (:goal (g)))"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("0: (a) [1]\n1.01: (b)\n1.02: (c) [1]", ""),
        ("0: (a) [1]\n0.5: (b)\n2: (c) [1]", "step 2: (b) lacks a condition at its start"),
        ("0: (a)\n1.01: (b)\n1.02: (c) [1]", "step 1: (a) cannot last 0.0 s"),
        ("0: (a)\n1.01: (b)\n1.02: (c)", "step 1: (a) takes time, but the plan has no durations"),
        ("(a)\n(b)\n(c)", "step 1: (a) takes time, but the plan has no durations"),
    ],
)
def test_steps_without_a_duration_take_no_time(text, fault):
    assert validate(parse_plan(text), *read(INSTANT.format("()"), DONE)) == fault


def test_conditions_are_not_skipped_for_want_of_durations():
    domain, problem = read(INSTANT.format("(and (at start (g)) (over all (q)))"), DONE.replace("(g)", "(p)"))
    assert "takes time" in validate(parse_plan("0.0: (a)"), domain, problem)


def test_simultaneous_steps_that_take_no_time_have_no_order():
    domain, problem = read(INSTANT.format("()"), DONE.replace("(:init)", "(:init (p))"))
    linked = completed(parse_plan("1: (b)\n1: (b)\n2: (c) [1]"), domain, problem)
    assert linked.orderings == ((1, 3), (2, 3))


@pytest.mark.parametrize(("number", "found"), [("120", 120), ("9" * 5000, None)])
def test_the_number_of_steps_of_an_excerpt_is_one_that_can_be_read(number, found):
    text = f";p\n; first 1 of {number} steps\n1:(a)\n"
    assert len(parse_plan(text).steps) == 1
    assert number_of_steps(text) == found
