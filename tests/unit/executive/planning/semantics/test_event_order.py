"""The validator and the linker put the events of another planner's plan in one order."""

import pytest

from tailor.executive.planning import PlanTextError, completed, format_links, parse_plan, validate
from tests.support.planning.planning_problems import read

SWITCH = """(define (domain d) (:requirements :durative-actions :timed-initial-literals) (:predicates (p) (q) (r))
  (:durative-action wait :parameters () :duration (= ?duration 5) :effect (at end (r)))
  (:action need :parameters () :precondition (or (q) (and (q) (p))) :effect (p))
  (:action make :parameters () :effect (q)))"""
GOAL_P = "(define (problem x) (:domain d) (:init) (:goal (p)))"


def test_an_instantaneous_action_happens_at_its_start_whatever_duration_is_printed():
    domain, problem = read(SWITCH, GOAL_P)
    late = parse_plan("0: (need) [5]\n1: (make) [0]\n")
    assert completed(late, domain, problem) == validate(late, domain, problem) != ""
    assert "lacks a condition at its start" in validate(late, domain, problem)
    usual = completed(parse_plan("0: (make) [0.001]\n0.001: (need) [0.001]\n"), domain, problem)
    assert [(step.start, step.duration) for step in usual.steps] == [(0.0, 0.0), (0.001, 0.0)]
    assert usual.orderings == ((1, 2),)
    assert validate(usual, domain, problem) == ""


def test_events_that_are_closer_than_the_linker_once_rounded_keep_their_order():
    domain, problem = read(
        """(define (domain d) (:requirements :durative-actions) (:predicates (p) (q) (r))
        (:durative-action light :parameters () :duration (= ?duration 1)
          :effect (and (at start (q)) (at end (not (q)))))
        (:durative-action read :parameters () :duration (= ?duration 2)
          :condition (at start (or (q) (and (p) (q)))) :effect (at end (r))))""",
        "(define (problem x) (:domain d) (:init) (:goal (r)))",
    )
    rows = [[0, "inf", "inf", "inf", "inf"], [-1000000000, 0, 1000000000, "inf", "inf"],
            [-2000000000, -1000000000, 0, "inf", "inf"], [-1999999999, "inf", "inf", 0, 2000000000],
            [-3999999999, "inf", "inf", -2000000000, 0]]  # fmt: skip
    table = "\n".join(" ".join(map(str, row)) for row in rows)
    text = f"Step 1 : (light)\nStep 2 : (read)\nGoal :\norderings =\n{table}\ntolerance = 0.000000001\n"
    linked = completed(parse_plan(text), domain, problem)
    assert validate(linked, domain, problem) == ""
    assert any(link.producer == 1 and link.consumer == 2 for link in linked.links)


def test_timed_literals_are_linked_at_their_place_among_steps_without_durations():
    domain, problem = read(
        SWITCH.replace("(:durative-action wait :parameters () :duration (= ?duration 5) :effect (at end (r)))", ""),
        GOAL_P.replace("(:init)", "(:init (at 1.5 (q)))"),
    )
    linked = completed(parse_plan("2: (need)\n"), domain, problem)
    assert validate(linked, domain, problem) == ""
    assert [(step.start, step.duration) for step in linked.steps] == [(2.0, 0.0)]
    assert "lacks a condition" in validate(parse_plan("1: (need)\n"), domain, problem)


def test_steps_that_are_printed_in_another_order_than_that_of_their_times_are_linked_in_time():
    domain, problem = read(SWITCH, GOAL_P)
    for text in ("2: (need)\n1: (make)\n", "2: (need) [0]\n1: (make) [0]\n"):
        linked = completed(parse_plan(text), domain, problem)
        assert validate(linked, domain, problem) == ""
        assert [step.action for step in linked.steps] == [("make",), ("need",)]
        assert "2   -> (q)" in format_links(linked)


@pytest.mark.parametrize("tick", ["0", "1e-10", "0.0000000001"])
def test_a_tick_below_a_nanosecond_is_refused(tick):
    with pytest.raises(PlanTextError, match="expected a tick of at least 1e-09 s"):
        parse_plan(f"Goal :\ntolerance = {tick}\n")
