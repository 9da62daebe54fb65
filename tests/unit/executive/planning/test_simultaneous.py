"""Events at the same time: those that interfere are kept apart; actions that need each other at once are found."""

import time

import pytest

from tailor.executive.planning import GroundCache, Search, Settings, validate
from tailor.executive.planning.ground.durations import TimeGrid, time_grid
from tests.support.planning.planning_problems import UNLIMITED, read, solve

PREDICATES = "(:constants a b) (:predicates (p ?x) (q) (r) (g))"
HEAD = f"(define (domain d) (:requirements :adl :durative-actions :timed-initial-literals) {PREDICATES}"
BOTH = [Settings(node_limit=500), Settings(node_limit=500, ground=False)]


def action(name, condition, effect, parameters="", duration=2):
    return (
        f"(:durative-action {name} :parameters ({parameters}) :duration (= ?duration {duration})"
        f" :condition (and {condition}) :effect (and {effect}))"
    )


def task(actions, initial, goal):
    return read(
        f"{HEAD} {' '.join(actions)})",
        f"(define (problem x) (:domain d) (:init {initial}) (:goal (and {goal})))",
    )


def starts(result):
    return {step.action: step.start for step in result.plan.steps}


@pytest.mark.parametrize("settings", BOTH, ids=["ground", "lifted"])
@pytest.mark.parametrize(
    ("one", "other", "initial"),
    [
        (action("one", "", "(at start (r)) (at end (q))"), action("two", "", "(at start (not (r))) (at end (g))"), ""),
        (
            action("one", "", "(at end (q)) (when (at start (r)) (at start (p a)))"),
            action("two", "", "(at start (not (r))) (at end (g))"),
            "(r)",
        ),
        (
            action("one", "(at start (or (r) (p a)))", "(at end (q))"),
            action("two", "", "(at start (not (p a))) (at end (g))"),
            "(r) (p a)",
        ),
    ],
    ids=["contrary effects", "a condition of an effect", "an alternative"],
)
def test_events_that_interfere_are_a_tick_apart(one, other, initial, settings):
    domain, problem = task([one, other], initial, "(q) (g)")
    result = solve(domain, problem, settings)
    assert validate(result.plan, domain, problem) == ""
    times = starts(result)
    assert abs(times["one",] - times["two",]) == pytest.approx(0.01)


@pytest.mark.parametrize("settings", BOTH, ids=["ground", "lifted"])
def test_events_without_interference_may_coincide(settings):
    actions = [action("one", "(at start (r))", "(at end (q))"), action("two", "(at start (r))", "(at end (g))")]
    assert set(starts(solve(*task(actions, "(r)", "(q) (g)"), settings)).values()) == {0.01}


@pytest.mark.parametrize("settings", BOTH, ids=["ground", "lifted"])
def test_actions_that_need_each_other_while_they_run_are_found(settings):
    hold = action("hold", "(at end (p ?y))", "(at start (p ?x))", "?x ?y")
    domain, problem = task([hold], "", "(p a)")
    result = solve(domain, problem, settings)
    assert validate(result.plan, domain, problem) == ""


@pytest.mark.parametrize("settings", BOTH, ids=["ground", "lifted"])
def test_an_action_may_make_its_own_later_condition_true(settings):
    domain, problem = task(
        [action("act", "(at end (r))", "(when (at start (q)) (at start (r))) (at end (g))")], "(q)", "(g)"
    )
    result = solve(domain, problem, settings)
    assert validate(result.plan, domain, problem) == ""
    assert len(result.plan.steps) == 1


@pytest.mark.parametrize("settings", BOTH, ids=["ground", "lifted"])
@pytest.mark.parametrize("time_s", ["0", "0.001", "0.009", "0.02"])
def test_a_timed_literal_shortly_after_the_start_is_a_threat(time_s, settings):
    domain, problem = task([action("act", "(at start (not (r)))", "(at end (g))")], f"(at {time_s} (r))", "(g)")
    result = solve(domain, problem, settings)
    assert (result.plan is None) == (time_s != "0.02")  # there is no time before it
    assert result.plan is None or validate(result.plan, domain, problem) == ""


def test_a_literal_at_time_0_is_one_of_the_initial_state():
    _, problem = task([action("act", "", "(at end (g))")], "(at 0 (r)) (at 0 (not (q))) (at 1 (p a))", "(g)")
    assert problem.initial == (("r",),)
    assert [timed.literal.fact for timed in problem.timed] == [("p", "a")]


def test_the_tick_is_no_longer_than_the_time_between_two_timed_literals():
    assert time_grid(1, [], [3.0, 3.25]) == TimeGrid(250_000_000, 1)
    assert time_grid(1, [], [3.0, 3.0]) == TimeGrid(10**9, 1)
    assert time_grid(0.01, [], [0.005]) == TimeGrid(5_000_000, 1)
    assert TimeGrid(10**7, 100).fits([1.0, 2.5])
    assert not TimeGrid(10**7, 100).fits([1.0, 1.5])
    assert not TimeGrid(10**9, 1).fits([1.5])


def test_ground_actions_with_too_long_a_tick_are_made_anew():
    cache = GroundCache()
    for time_s, sound in (("0.5", True), ("0.004", False)):
        domain, problem = task([action("act", "(at start (not (r)))", "(at end (g))")], f"(at {time_s} (r))", "(g)")
        result = Search(domain, problem, Settings(), cache).advance(_Unlimited())
        assert (result.plan is not None) == sound


@pytest.mark.parametrize("time_s", ["0.004", "0.5"])
def test_the_tick_does_not_depend_on_the_timed_literals_of_an_earlier_problem(time_s):
    cache, acts = GroundCache(), [action("act", "(at start (not (r)))", "(at start (r)) (at end (g))")]
    domain, earlier = task(acts, f"(at {time_s} (not (r)))", "(g)")
    assert Search(domain, earlier, Settings(), cache).advance(_Unlimited()).plan is not None
    _, later = task(acts, "", "(g)")
    plan = Search(domain, later, Settings(), cache).advance(_Unlimited()).plan
    assert plan.steps == solve(domain, later, Settings()).plan.steps


class _Unlimited:
    granted = 0

    def spent(self):
        self.granted += 1
        return self.granted > UNLIMITED


@pytest.mark.parametrize("settings", BOTH, ids=["ground", "lifted"])
def test_a_quantifier_over_millions_of_objects_that_grounding_decides_at_once_takes_no_time(settings):
    many = "(exists (?a ?b ?c ?d ?e ?f ?i ?j) (or (= ?a ?a) (p ?b)))"  # ten to the 8th, one of which decides it
    actions = [action("one", f"(at start {many})", "(at end (g))"), action("two", "", "(at start (p b)) (at end (q))")]
    objects = "(:objects " + " ".join(f"o{n}" for n in range(8)) + ")"
    domain, problem = read(
        f"{HEAD} {' '.join(actions)})",
        f"(define (problem x) (:domain d) {objects} (:init) (:goal (and (q) (g))))",
    )
    began = time.process_time()
    result = solve(domain, problem, settings)
    assert time.process_time() - began < 5
    assert validate(result.plan, domain, problem) == ""
    times = starts(result)
    assert abs(times["one",] - times["two",]) == pytest.approx(0.01)  # one of the alternatives is changed


@pytest.mark.parametrize("settings", BOTH, ids=["ground", "lifted"])
def test_a_quantifier_over_no_objects_reads_nothing(settings):
    actions = [
        action("one", "(at start (forall (?n - none) (r)))", "(at end (g))"),
        action("two", "", "(at start (r)) (at end (q))"),
    ]
    domain, problem = task(["(:types none)", *actions], "", "(q) (g)")
    result = solve(domain, problem, settings)
    assert validate(result.plan, domain, problem) == ""
    assert len(set(starts(result).values())) == 1


@pytest.mark.parametrize("settings", BOTH, ids=["ground", "lifted"])
@pytest.mark.parametrize(("read_by", "apart"), [("a", True), ("b", False)])
def test_a_derived_predicate_of_a_narrower_type_reads_what_its_argument_does(read_by, apart, settings):
    actions = [
        action("one", "(at start (or (q) (ready ?x)))", f"(when (at start (= ?x {read_by})) (at end (g)))", "?x"),
        action("two", "", "(at start (p a)) (at end (r))"),
    ]
    derived = "(:types item) (:derived (ready ?i - item) (not (p ?i)))"
    predicates = "(:constants a b - item) (:predicates (p ?x) (q) (r) (g) (ready ?x))"
    domain, problem = read(
        f"(define (domain d) (:requirements :adl :durative-actions) {predicates} {derived} {' '.join(actions)})",
        "(define (problem x) (:domain d) (:init (q)) (:goal (and (g) (r))))",
    )
    result = solve(domain, problem, settings)
    assert validate(result.plan, domain, problem) == ""
    assert (len(set(starts(result).values())) == 2) == apart
