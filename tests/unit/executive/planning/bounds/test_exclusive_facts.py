"""Groups of facts of which at most one holds: found where every action takes one before it adds one, else refused."""

import pytest

from tailor.executive.planning.bounds.exclusive_facts import exclusive_facts
from tailor.executive.planning.ground.ground_task import make_task
from tailor.executive.planning.ground.grounding import ground_actions, static_world
from tailor.executive.planning.plans.portions import completed_work
from tests.support.planning.planning_problems import read

GO = "(at start (at ?r ?x))", "(at start (not (at ?r ?x))) (at end (at ?r ?y))"
DOMAIN = """(define (domain visits) (:requirements :durative-actions :timed-initial-literals)
  (:predicates (at ?r ?x) (free ?r) (wet ?x) (seen ?x))
  (:durative-action go :parameters (?r ?x ?y) :duration (= ?duration 5) :condition (and {}) :effect (and {}))
  (:durative-action look :parameters (?r ?x) :duration (and (>= ?duration 7) (<= ?duration 9))
    :condition (and (over all (at ?r ?x)) (at start (free ?r)))
    :effect (and (at start (not (free ?r))) (at end (free ?r)) (at end (seen ?x)))))"""
PROBLEM = """(define (problem p) (:domain visits) (:objects a h k)
  (:init (at a h) (free a) {}) (:goal (and (seen h) (seen k))))"""


def groups_of(condition=GO[0], effect=GO[1], initial=""):
    """The groups, each with its facts, and the times by action, in seconds."""
    _, problem = read(DOMAIN.format(condition, effect), PROBLEM.format(initial))
    *_, grounded = ground_actions(problem, static_world(problem), 0.01, 10_000)
    task = completed_work(make_task(problem, grounded))
    exclusive = completed_work(exclusive_facts(task))
    groups = {}
    for literal, own in exclusive.groups.items():
        for group in own:
            groups.setdefault(group, set()).add(task.names[literal].fact)
    names = {action.number: action.name for action in grounded.actions}
    unit = task.grid.unit_s
    moves = {names[n]: {g: round(t * unit, 6) for g, t in times.items()} for n, times in exclusive.moves.items()}
    ways = {task.names[n].fact: {g: round(t * unit, 6) for g, t in own.items()} for n, own in exclusive.ways.items()}
    return groups, moves, ways


PLACES = (2, ("at", "a"))
FREE = (0, ("free", "a"))


def test_the_places_of_a_robot_and_that_it_is_free_are_exclusive():
    groups, moves, ways = groups_of()
    assert groups[PLACES] >= {("at", "a", "h"), ("at", "a", "k")}
    assert groups[FREE] == {("free", "a")}
    assert not any(group[1][0] == "seen" for group in groups)
    assert moves[("go", "a", "h", "k")] == {PLACES: 5}
    assert moves[("look", "a", "k")] == {FREE: 7, (1, ("free",)): 7}
    assert ways[("at", "a", "k")] == {PLACES: 5}


@pytest.mark.parametrize(
    ("why", "changes"),
    [
        ("two hold initially", {"initial": "(at a k)"}),
        ("one is added at a set time", {"initial": "(at 3 (at a k))"}),
        ("nothing is taken", {"effect": "(at end (at ?r ?y))"}),
        ("what is taken is not required", {"condition": "(at start (free ?r))"}),
        ("it is required at the start, taken at the end", {"effect": "(at end (not (at ?r ?x))) (at end (at ?r ?y))"}),
        ("it is taken after one is added", {
            "condition": "(over all (at ?r ?x))", "effect": "(at end (not (at ?r ?x))) (at start (at ?r ?y))"}),
        ("two are added", {"effect": GO[1] + " (at end (at ?r ?x))"}),
        ("it may stay", {"effect": "(when (at start (wet ?x)) (at start (not (at ?r ?x)))) (at end (at ?r ?y))"}),
    ],
)  # fmt: skip
def test_places_are_not_exclusive_where(why, changes):
    groups, moves, _ = groups_of(**changes)
    assert PLACES not in groups, why
    assert FREE in groups
    assert all(PLACES not in times for times in moves.values())


def test_an_action_that_moves_at_once_takes_no_time_between_two_facts():
    groups, moves, ways = groups_of(effect="(at start (not (at ?r ?x))) (at start (at ?r ?y))")
    assert PLACES in groups
    assert moves[("go", "a", "h", "k")] == {}
    assert ways[("at", "a", "k")] == {PLACES: 0}


def test_a_fact_that_is_required_throughout_may_be_taken_at_the_end():
    groups, moves, _ = groups_of("(over all (at ?r ?x))", "(at end (not (at ?r ?x))) (at end (at ?r ?y))")
    assert PLACES in groups
    assert moves[("go", "a", "h", "k")] == {}
