"""Interfering events are kept apart in whichever orders fit; where a search for these gave up, there is no proof."""

import itertools

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import AnytimeSearch, Settings, parse_plan, validate
from tailor.executive.planning.ground_plans import separation
from tests.support.planning.planning_problems import read, solve

DOMAIN = """(define (domain d) (:requirements :durative-actions :timed-initial-literals :conditional-effects)
  (:predicates (open-a) (open-b) (open-c) (x) (z) (y) (done-a) (done-b) (done-c))
  (:durative-action a :parameters () :duration (= ?duration 10) :condition (at start (open-a))
    :effect (and (at end (done-a)) (when (at start (x)) (at end (y)))))
  (:durative-action b :parameters () :duration (= ?duration 10) :condition (at start (open-b))
    :effect (and (at end (done-b)) (at start (x)) (at start (z))))
  (:durative-action c :parameters () :duration (= ?duration 10) :condition (at start (open-c))
    :effect (and (at end (done-c)) (when (at start (z)) (at end (y))))))"""
# b is at 1 or 2, c at 2, a at 1, 2 or 3, and neither a nor c at the time of b: b must be at 1, before a
PROBLEM = """(define (problem x) (:domain d) (:init (open-a) (open-b) (at 1 (open-c)) (at 4 (not (open-a)))
  (at 3 (not (open-b))) (at 3 (not (open-c)))) (:goal (and {})))"""
GOALS = list(map(" ".join, itertools.permutations(["(done-a)", "(done-b)", "(done-c)"])))


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
@pytest.mark.parametrize("goal", GOALS)
def test_the_order_of_the_goals_does_not_decide_whether_there_is_a_schedule(goal, ground):
    domain, problem = read(DOMAIN, PROBLEM.format(goal))
    assert validate(parse_plan("1: (b) [10]\n2: (a) [10]\n2: (c) [10]"), domain, problem) == ""
    result = solve(domain, problem, Settings(tolerance_s=1, ground=ground))
    assert result.status == "solved"
    assert validate(result.plan, domain, problem) == ""


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_without_any_schedule_there_is_no_plan(ground):
    domain, problem = read(DOMAIN, PROBLEM.format(GOALS[0]).replace("at 3 (not (open-b))", "at 2 (not (open-b))"))
    assert solve(domain, problem, Settings(tolerance_s=1, ground=ground)).status == "solved"
    domain, problem = read(DOMAIN.replace("(z)) (at end (y))", "(x)) (at end (y))"), problem_without_room())
    assert solve(domain, problem, Settings(tolerance_s=1, ground=ground)).status == "unsolvable"


def problem_without_room():
    """Of a, b and c, of which b must be apart from both, all at 1."""
    times = "(open-c) (at 2 (not (open-a))) (at 2 (not (open-b))) (at 2 (not (open-c)))"
    return f"(define (problem x) (:domain d) (:init (open-a) (open-b) {times}) (:goal (and {GOALS[0]})))"


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_a_plan_whose_schedules_were_not_all_tried_is_no_dead_end(monkeypatch, ground):
    monkeypatch.setattr(separation, "MAX_REVISED", 0)
    domain, problem = read(DOMAIN, PROBLEM.format(GOALS[0]))
    result = solve(domain, problem, Settings(tolerance_s=1, ground=ground))
    assert result.status == "limit"
    assert "gave up to look for a schedule" in result.reason


UNBOUND = """(define (domain d) (:requirements :durative-actions :timed-initial-literals :conditional-effects)
  (:constants o1) (:predicates (open) (x ?o) (y) (done-b) (done-c))
  (:durative-action b :parameters (?o) :duration (= ?duration 10) :condition (at start (open))
    :effect (and (at end (done-b)) (at start (x ?o))))
  (:durative-action c :parameters () :duration (= ?duration 10) :condition (at start (open))
    :effect (and (at end (done-c)) (when (at start (x o1)) (at end (y))))))"""


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_the_object_that_no_condition_determines_is_one_that_has_a_schedule(ground):
    init = "(:objects o2) (:init (open) (at 2 (not (open))))"
    domain, problem = read(UNBOUND, f"(define (problem x) (:domain d) {init} (:goal (and (done-b) (done-c))))")
    result = solve(domain, problem, Settings(tolerance_s=1, ground=ground))
    assert result.status == "solved"
    assert {step.action for step in result.plan.steps} == {("b", "o2"), ("c",)}
    assert validate(result.plan, domain, problem) == ""


SHORT_AND_LONG = """(define (domain d) (:requirements :durative-actions) (:predicates (p) (r) (s))
  (:durative-action long :parameters () :duration (= ?duration 2) :effect (and (at start (r)) (at start (p))))
  (:action short :parameters () :effect (and (not (r)) (s))))"""


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
@pytest.mark.parametrize("goal", ["(p) (s)", "(s) (p)"])
def test_of_several_schedules_the_shortest_is_proven_to_be_the_best(goal, ground):
    domain, problem = read(SHORT_AND_LONG, f"(define (problem x) (:domain d) (:init) (:goal (and {goal})))")
    search = AnytimeSearch(domain, problem, Settings(tolerance_s=1, ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert (search.ended, search.value) == ("proven", 3)  # long at 1, short at 2; not short at 1, long at 2


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
@pytest.mark.parametrize("goal", ["(p) (s)", "(s) (p)"])
def test_a_schedule_that_may_not_be_the_shortest_is_not_proven_to_be_the_best(monkeypatch, goal, ground):
    monkeypatch.setattr(separation, "MAX_REVISED", 0)
    domain, problem = read(SHORT_AND_LONG, f"(define (problem x) (:domain d) (:init) (:goal (and {goal})))")
    search = AnytimeSearch(domain, problem, Settings(tolerance_s=1, ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert search.value == 3 or "may have a shorter schedule" in search.ended


def test_a_schedule_that_may_not_be_the_shortest_is_a_plan_of_least_cost(monkeypatch):
    monkeypatch.setattr(separation, "MAX_REVISED", 0)
    text = SHORT_AND_LONG.replace("(:predicates", "(:functions (total-cost)) (:predicates").replace(
        "(and (not (r))", "(and (increase (total-cost) 1) (not (r))"
    )
    problem_text = "(define (problem x) (:domain d) (:init) (:goal (and (s) (p))) (:metric minimize (total-cost)))"
    search = AnytimeSearch(*read(text, problem_text), Settings(tolerance_s=1))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert (search.ended, search.value) == ("proven", 1)


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_effects_that_do_not_happen_are_not_kept_apart(ground):
    domain, problem = read(
        """(define (domain d) (:requirements :durative-actions :conditional-effects) (:predicates (p) (q) (s))
        (:durative-action a :parameters () :duration (>= ?duration 2)
          :effect (and (at start (q)) (when (at start (q)) (at end (not (p))))))
        (:durative-action b :parameters () :duration (= ?duration 3) :effect (and (at start (s)) (at end (p)))))""",
        "(define (problem x) (:domain d) (:init (at 3 (p))) (:goal (and (p) (q) (s))))",
    )
    assert validate(parse_plan("1: (a) [3]\n1: (b) [3]"), domain, problem) == ""  # ends at 4: q did not hold
    search = AnytimeSearch(domain, problem, Settings(tolerance_s=1, ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert (search.ended, search.value) == ("proven", 4)


# a may set w, which b reads when both end: at 3, if a starts before c has changed z, which decides it
UNORDERED = """(define (domain d) (:requirements :durative-actions :conditional-effects)
  (:predicates (z) (w) (v) (done-a) (done-b) (done-c))
  (:durative-action a :parameters () :duration (= ?duration 2)
    :effect (and (at end (done-a)) (when (at start (z)) (at end (w)))))
  (:durative-action b :parameters () :duration (= ?duration 2)
    :effect (and (at end (done-b)) (when (at end (w)) (at end (v)))))
  (:durative-action c :parameters () :duration (= ?duration 2) :effect (and (at end (done-c)) (at end {}))))"""


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
@pytest.mark.parametrize(("init", "change", "makespan"), [("", "(z)", 3), ("(z)", "(not (z))", 4)], ids=["no", "yes"])
def test_events_are_kept_apart_if_an_effect_happens_at_their_times(init, change, makespan, ground):
    goal = "(and (done-a) (done-b) (done-c))"
    domain, problem = read(UNORDERED.format(change), f"(define (problem x) (:domain d) (:init {init}) (:goal {goal}))")
    search = AnytimeSearch(domain, problem, Settings(tolerance_s=1, ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert validate(search.best.plan, domain, problem) == ""
    assert search.value == makespan
    assert (search.ended == "proven") == (makespan == 3)  # at other times the effect might not happen


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_a_plan_that_takes_too_long_to_simulate_is_not_proven_to_be_the_best(monkeypatch, ground):
    monkeypatch.setattr(separation, "MAX_PORTIONS", 2)
    goal = "(and (done-a) (done-b) (done-c))"
    domain, problem = read(UNORDERED.format("(z)"), f"(define (problem x) (:domain d) (:init) (:goal {goal}))")
    search = AnytimeSearch(domain, problem, Settings(tolerance_s=1, ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert "may have a shorter schedule" in search.ended


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_effects_that_happen_whatever_the_order_are_kept_apart_in_the_best_schedule(ground):
    domain, problem = read(
        UNORDERED.format("(v)"),
        "(define (problem x) (:domain d) (:init (z)) (:goal (and (done-a) (done-b))))",
    )
    search = AnytimeSearch(domain, problem, Settings(tolerance_s=1, ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert (search.ended, search.value) == ("proven", 4)


# a sets w unless z is false, which b reads when both end: at 4, if c makes z false, which no condition requires
UNASKED = """(define (domain d) (:requirements :durative-actions :timed-initial-literals :conditional-effects)
  (:constants o) (:predicates (z ?o) (w) (v) (begun) (done-a) (done-b) (open-a) (open-b))
  (:durative-action a :parameters () :duration (= ?duration 2) :condition (at start (and (begun) (open-a)))
    :effect (and (at end (done-a)) (when (at start {condition}) (at end (w)))))
  (:durative-action b :parameters () :duration (= ?duration 3) :condition (at start (open-b))
    :effect (and (at start (begun)) (at end (done-b)) (when (at end (w)) (at end (v)))))
  (:action c :parameters ({parameters}) :effect {effect}))"""
WITH_C = "1: (b) [3]\n1: (c{}) [0]\n2: (a) [2]"
ENDED = [
    ("(z o)", "", "(not (z o))"),
    ("(not (z o))", "", "(z o)"),
    ("(forall (?o) (z ?o))", "", "(not (z o))"),
    ("(or (z o) (w))", "?x", "(forall (?y) (when (= ?x ?y) (not (z ?x))))"),
]


def unasked(condition, parameters, effect, timed=""):
    holding = "" if condition.startswith("(not") else "(z o)"
    domain, problem = read(
        UNASKED.format(condition=condition, parameters=parameters, effect=effect),
        f"(define (problem x) (:domain d) (:init {holding} (open-a) (open-b) {timed}) (:goal (and (done-a) (done-b))))",
    )
    plan = parse_plan(WITH_C.format(" o" if parameters else ""))
    assert (plan.makespan, validate(plan, domain, problem)) == (4, "")
    return domain, problem


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
@pytest.mark.parametrize("ended", ENDED)
def test_a_step_that_no_condition_requires_may_let_events_coincide(ended, ground):
    search = AnytimeSearch(*unasked(*ended), Settings(tolerance_s=1, ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert search.value == 4 or "may have a shorter schedule" in search.ended


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
@pytest.mark.parametrize("ended", ENDED)
def test_a_plan_without_a_schedule_is_no_dead_end_if_another_step_gives_it_one(ended, ground):
    times = "(at 2 (not (open-b))) (at 3 (not (open-a)))"  # b at 1, a at 2
    result = solve(*unasked(*ended, timed=times), Settings(tolerance_s=1, ground=ground))
    assert (result.status, "gave up to look for a schedule" in result.reason) == ("limit", True)


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
@pytest.mark.parametrize("effect", ["(z o)", "(not (z ?x))"])
def test_a_schedule_is_the_shortest_if_no_step_can_end_what_keeps_events_apart(effect, ground):
    domain, problem = read(
        UNASKED.format(condition="(z o)", parameters="?x - none", effect=effect).replace(
            "(:constants", "(:types none) (:constants"
        ),
        "(define (problem x) (:domain d) (:init (z o) (open-a) (open-b)) (:goal (and (done-a) (done-b))))",
    )
    search = AnytimeSearch(domain, problem, Settings(tolerance_s=1, ground=ground))
    while not search.ended:
        search.advance(CheckBudget(100))
    assert (search.ended, search.value) == ("proven", 5)
