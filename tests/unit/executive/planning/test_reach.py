"""Large problems are grounded by relaxed reachability: same plans and counts, and a clear refusal beyond the limits."""

import random
import time
from dataclasses import replace

import pytest

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import DEFAULT, MATCHING, GroundCache, Search, Settings, validate
from tailor.executive.planning.ground import grounding
from tailor.executive.planning.ground.bindings import least_bindings, schema_bindings
from tailor.tools.plan_search.limits import GROUND_LIMIT
from tests.support.cpu_time import standard_cpu_s
from tests.support.planning.planning_problems import OWN, own, read, solve

LOGISTICS = """(define (domain logistics) (:requirements :strips)
  (:predicates (obj ?o) (truck ?t) (location ?l) (city ?c) (at ?o ?l) (in ?o ?t) (in-city ?l ?c))
  (:action load :parameters (?o ?t ?l) :precondition (and (obj ?o) (truck ?t) (location ?l) (at ?t ?l) (at ?o ?l))
    :effect (and (not (at ?o ?l)) (in ?o ?t)))
  (:action unload :parameters (?o ?t ?l) :precondition (and (obj ?o) (truck ?t) (location ?l) (at ?t ?l) (in ?o ?t))
    :effect (and (not (in ?o ?t)) (at ?o ?l)))
  (:action drive :parameters (?t ?f ?to ?c)
    :precondition (and (truck ?t) (location ?f) (location ?to) (city ?c) (at ?t ?f) (in-city ?f ?c) (in-city ?to ?c))
    :effect (and (not (at ?t ?f)) (at ?t ?to))))"""


def logistics(cities, places, parcels):
    """Untyped, as in 1998; each city has one truck, and each parcel stays in its city."""
    rng = random.Random(1)
    init, goal = [], []
    for c in range(cities):
        init += [f"(city c{c}) (truck t{c}) (at t{c} l{c}x0)"]
        init += [f"(location l{c}x{n}) (in-city l{c}x{n} c{c})" for n in range(places)]
    for p in range(parcels):
        c = p % cities
        init.append(f"(obj p{p}) (at p{p} l{c}x{rng.randrange(1, places)})")
        goal.append(f"(at p{p} l{c}x0)")
    objects = [f"c{c} t{c}" for c in range(cities)] + [f"p{p}" for p in range(parcels)]
    objects += [f"l{c}x{n}" for c in range(cities) for n in range(places)]
    text = f"(:objects {' '.join(objects)}) (:init {' '.join(init)}) (:goal (and {' '.join(goal[:2])}))"
    return read(LOGISTICS, f"(define (problem p) (:domain logistics) {text})")


@pytest.fixture
def by_reachability(monkeypatch):
    monkeypatch.setattr(grounding, "MAX_BINDINGS", 0)


def test_many_candidates_of_which_few_are_reachable_are_no_obstacle():
    domain, problem = logistics(20, 6, 20)
    assert len(problem.objects) ** 3 > 4_000_000  # bindings of a load
    result = solve(domain, problem, DEFAULT)
    assert validate(result.plan, domain, problem) == ""
    assert result.generated < 1000


@pytest.mark.parametrize("settings", [MATCHING, DEFAULT], ids=["matching", "default"])
@pytest.mark.parametrize("name", OWN)
def test_reachable_actions_give_the_same_search(name, settings, by_reachability, monkeypatch):
    result = solve(*own(name), settings)
    monkeypatch.undo()
    assert result == solve(*own(name), settings)


@pytest.mark.parametrize("name", OWN)
def test_what_is_surely_too_much_to_try_is_at_most_what_is_tried(name):
    domain, problem = own(name)
    world = grounding.static_world(problem)
    for schema in domain.actions:
        tried = list(schema_bindings(schema, world))
        assert 1 <= least_bindings(schema, world) <= len(tried)


def test_actions_that_are_surely_too_many_are_not_tried_one_by_one(monkeypatch):
    monkeypatch.setattr(grounding, "_exhaustive", None)
    actions = " ".join(f"(:action a{n} :parameters (?x ?y) :effect (p ?x ?y))" for n in range(50))
    domain = f"(define (domain d) (:predicates (p ?x ?y)) {actions})"
    objects = " ".join(f"o{n}" for n in range(10))
    text = f"(define (problem p) (:domain d) (:objects {objects}) (:init) (:goal (p o1 o2)))"
    assert solve(*read(domain, text)).status == "solved"


def objects(count):
    return " ".join(f"o{n}" for n in range(count))


def many_parameters():
    """One action with 50 to the 8th bindings, all of them reachable."""
    parameters = " ".join(f"?x{n}" for n in range(8))
    domain = f"""(define (domain d) (:predicates (p ?x) (q))
      (:action small :parameters (?x) :precondition (q) :effect (p ?x))
      (:action huge :parameters ({parameters}) :precondition (and (p ?x0) (p ?x1)) :effect (q)))"""
    facts = "(p o0) (p o1) (p o2)"
    return read(
        domain, f"(define (problem p) (:domain d) (:objects {objects(50)}) (:init {facts}) (:goal (and (q) (p o1))))"
    )


def many_effects():
    """45 000 reachable actions with 60 effects each: 2.7 million facts."""
    conditions = " ".join(f"(c{n} ?x)" for n in range(60))
    effects = " ".join(f"(d{n} ?x ?y)" for n in range(60))
    domain = f"""(define (domain d) (:predicates {conditions} {effects})
      (:action huge :parameters (?x ?y) :precondition (and {conditions}) :effect (and {effects}))
      (:action back :parameters (?x ?y) :precondition (d0 ?x ?y) :effect (and {conditions})))"""
    facts = " ".join(f"(c{n} o{k})" for n in range(60) for k in range(150))
    return read(
        domain, f"(define (problem p) (:domain d) (:objects {objects(300)}) (:init {facts}) (:goal (d1 o2 o3)))"
    )


@pytest.mark.parametrize(
    ("problem", "named"),
    [(many_parameters, "'huge'"), (many_effects, "'huge'"), (lambda: logistics(10, 60, 800), "'load'")],
    ids=["many parameters", "many effects", "many parcels"],
)
def test_refusal_takes_at_most_two_seconds_and_names_what_is_too_large(problem, named):
    domain, parsed = problem()

    def refuse():
        result = solve(domain, parsed, replace(DEFAULT, ground_limit=GROUND_LIMIT))
        assert result.status == "limit"
        assert named in result.reason

    assert standard_cpu_s(refuse) < 2  # 0.2 to 0.8 s


@pytest.mark.parametrize(
    "goal",
    [
        "(exists (?a ?b) (and (p ?a ?b) (not (p ?a ?b))))",
        "(forall (?x) (or (q ?x) (and (q ?x) (not (q ?x)) (p ?x ?x))))",
    ],
)
def test_quantified_contradictions_are_folded_before_the_search(goal):
    domain = """(define (domain d) (:requirements :adl) (:predicates (p ?x ?y) (q ?x) (never))
      (:action a :parameters (?x ?y) :precondition (q ?x) :effect (p ?x ?y))
      (:action b :parameters (?x ?y) :precondition (q ?x) :effect (not (p ?x ?y)))
      (:action c :parameters (?x) :precondition (never) :effect (q ?x)))"""
    objects = " ".join(f"o{n}" for n in range(60))
    text = f"(define (problem p) (:domain d) (:objects {objects}) (:init (q o1)) (:goal {goal}))"
    result = solve(*read(domain, text))
    assert result.status == "unsolvable"
    assert result.generated <= 1


def test_memory_of_the_ground_actions_is_limited(monkeypatch):
    monkeypatch.setattr(grounding, "MAX_BYTES", 20_000)
    result = solve(*logistics(20, 6, 20))
    assert result.status == "limit"
    assert "memory" in result.reason


def test_conditional_effects_over_all_objects_are_reached(by_reachability):
    domain = """(define (domain d) (:requirements :adl) (:predicates (at ?x) (in ?x) (gone ?x) (link ?x ?y))
      (:action move :parameters (?from ?to) :precondition (and (link ?from ?to) (at ?from))
        :effect (and (at ?to) (not (at ?from)) (forall (?from) (when (in ?from) (gone ?from))))))"""
    text = """(define (problem p) (:domain d) (:objects a b k)
      (:init (at a) (link a b) (in k)) (:goal (and (at b) (gone k))))"""
    result = solve(*read(domain, text))
    assert [step.action for step in result.plan.steps] == [("move", "a", "b")]


def test_a_condition_that_the_actions_own_start_makes_true_needs_no_other_action(by_reachability):
    domain = """(define (domain d) (:requirements :durative-actions) (:predicates (lit ?x) (done ?x) (room ?x))
      (:durative-action work :parameters (?x) :duration (= ?duration 2)
        :condition (and (at start (room ?x)) (over all (lit ?x)) (at end (lit ?x)))
        :effect (and (at start (lit ?x)) (at end (done ?x)))))"""
    text = "(define (problem p) (:domain d) (:objects a) (:init (room a)) (:goal (done a)))"
    assert solve(*read(domain, text)).status == "solved"


BRIDGE = """(define (domain d) (:requirements :adl :durative-actions) (:predicates (at ?x) (held ?x) (road ?x ?y))
  (:durative-action cross :parameters (?x ?y) :duration (= ?duration 5)
    :condition (and (at start (road ?x ?y)) (at start (at ?x)) (at end (held ?y))) :effect {})
  (:durative-action hold :parameters (?y) :duration (= ?duration 1) :condition (at start (at ?y))
    :effect (at start (held ?y))))"""


def bridge(effect, places, goal):
    """A chain of places; crossing from one to the next ends only if the next is held, from where one is at once."""
    roads = " ".join(f"(road o{n} o{n + 1})" for n in range(places - 1))
    objects = " ".join(f"o{n}" for n in range(places))
    text = f"(define (problem p) (:domain d) (:objects {objects}) (:init (at o0) {roads}) (:goal (at o{goal})))"
    return read(BRIDGE.format(effect), text)


@pytest.mark.parametrize(
    "effect", ["(at start (at ?y))", "(forall (?z) (when (at start (road ?x ?z)) (at start (at ?z))))"]
)
def test_the_start_of_an_action_serves_those_that_its_end_waits_for(effect, by_reachability):
    domain, problem = bridge(effect, 4, 3)
    result = solve(domain, problem, Settings(node_limit=500))
    assert {step.action[0] for step in result.plan.steps} == {"cross", "hold"}
    assert validate(result.plan, domain, problem) == ""


def test_thousands_of_starts_one_after_another_are_tried_once_each():
    domain, problem = bridge("(at start (at ?y))", 3000, 2)
    began = time.process_time()
    assert solve(domain, problem).status == "solved"
    assert time.process_time() - began < 10


def test_facts_and_timed_literals_are_both_reached(by_reachability):
    domain = """(define (domain d) (:requirements :timed-initial-literals) (:predicates (open ?x) (in ?x))
      (:action enter :parameters (?x) :precondition (open ?x) :effect (in ?x)))"""
    text = "(define (problem p) (:domain d) (:objects a) (:init (at 3 (open a))) (:goal (in a)))"
    assert solve(*read(domain, text)).plan.steps[0].start > 3


def test_equalities_and_negated_static_facts_are_tested(by_reachability):
    domain = """(define (domain d) (:requirements :adl) (:constants k) (:predicates (p ?x) (bad ?x) (q ?x ?y) (r ?x))
      (:action a :parameters (?x ?y) :precondition (and (p ?x) (p ?y) (not (= ?x ?y)) (not (bad ?y)) (not (= ?x k)))
        :effect (q ?x ?y)))"""
    text = """(define (problem p) (:domain d) (:objects a b c) (:init (p a) (p b) (p c) (p k) (bad c))
      (:goal (exists (?x ?y) (and (q ?x ?y) (not (= ?y k))))))"""
    cache = GroundCache()
    domain, problem = read(domain, text)
    assert Search(domain, problem, MATCHING, cache).advance(CheckBudget(1000)).status == "solved"
    assert {a.name[1:] for a in cache.last.actions} == {(x, y) for x in "abc" for y in ("a", "b", "k") if x != y}


def test_grounding_is_reused_only_where_the_facts_were_reached(by_reachability):
    domain, problem = logistics(2, 3, 2)
    cache = GroundCache()
    solve_now = lambda problem: Search(domain, problem, MATCHING, cache).advance(CheckBudget(10**6))  # noqa: E731
    solve_now(problem)
    first = cache.last
    moved = problem.with_initial(
        [fact for fact in problem.initial if fact != ("at", "t0", "l0x0")] + [("at", "t0", "l0x2")]
    )
    assert solve_now(moved) == solve(domain, moved)
    assert cache.last is first
    elsewhere = problem.with_initial([*problem.initial, ("at", "p1", "l0x2")])
    assert solve_now(elsewhere) == solve(domain, elsewhere)
    assert cache.last is not first


def test_grounding_of_large_problems_is_resumed():
    domain, problem = logistics(20, 6, 20)
    search = Search(domain, problem, Settings())
    portions = 1
    while (result := search.advance(CheckBudget(20))) is None:
        portions += 1
    assert portions > 10
    assert result == solve(domain, problem, Settings())


def test_rules_are_prepared_in_portions():
    """A tick of the executive advances by a few portions, however many actions a domain has."""
    actions = " ".join(f"(:action a{n} :parameters (?x ?y ?z) :effect (p ?x ?y ?z))" for n in range(300))
    domain, problem = read(
        f"(define (domain d) (:predicates (p ?x ?y ?z)) {actions})",
        f"(define (problem x) (:domain d) (:objects {' '.join(f'o{n}' for n in range(100))}) (:goal (p o1 o2 o3)))",
    )
    search = Search(domain, problem)
    assert search.advance(CheckBudget(200)) is None, "one check a rule"
    assert search.advance(CheckBudget(10**6)).status == "limit"
