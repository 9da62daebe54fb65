"""The order in which achievers are tried: by it plans of equal rank fall, and with them every count."""

from tailor.executive.planning.ground.achievers import SIZES
from tailor.executive.planning.ground.ground_task import make_task
from tailor.executive.planning.ground.grounding import ground_actions, static_world
from tailor.executive.planning.plans.portions import completed_work
from tests.support.planning.planning_problems import read

DOMAIN = """(define (domain d) (:requirements :typing) (:types lamp)
  (:predicates (power) (lit ?l - lamp) (light) (dark ?l - lamp))
  (:action burn :parameters (?l - lamp) :precondition (lit ?l) :effect (light))
  (:action switch :parameters (?l - lamp) :precondition (power) :effect (and (light) (lit ?l) (not (dark ?l)))))"""


def achievers(lamps):
    """Of (light)."""
    objects = " ".join(f"l{n:03}" for n in range(lamps))
    parts = f"(:objects {objects} - lamp) (:init (power)) (:goal (light))"
    _, problem = read(DOMAIN, f"(define (problem p) (:domain d) {parts})")
    *_, grounded = ground_actions(problem, static_world(problem), 0.01, 10_000)
    task = completed_work(make_task(problem, grounded))
    number = next(n for n, name in enumerate(task.names) if name.positive and name.fact == ("light",))
    return [(action.name[0], int(action.name[1][1:])) for action, _ in task.achievers[number]]


def test_the_first_found_stays_first_and_later_ones_stand_newest_first():
    # level 1 has the switches; only then the lamps can burn, though "burn" comes first by name
    assert achievers(2) == [("switch", 0), ("burn", 1), ("burn", 0), ("switch", 1)]


def test_every_list_is_turned_round_when_the_table_of_all_achievers_grows():
    lamps = SIZES[0] // 4  # four effects each: the table is not full yet
    before, after = achievers(lamps), achievers(lamps + 1)
    assert (before[0], before[-1]) == (("switch", 0), ("switch", 1))
    assert (after[0], after[-1]) == (("switch", 1), ("switch", 0))
