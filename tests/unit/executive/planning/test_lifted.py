"""What is peculiar to planning with variables: bindings instead of objects, and limits where these bring nothing."""

import pytest

from tailor.executive.planning import Settings, format_links, parse_plan, validate
from tailor.executive.planning.lifted.bindings import Bindings
from tests.support.cpu_time import standard_cpu_s
from tests.support.planning.planning_problems import own, read, solve

LIFTED = Settings(ground=False)


def planned(domain_text, problem_text, settings=LIFTED):
    domain, problem = read(domain_text, problem_text)
    result = solve(domain, problem, settings)
    assert result.status == "solved", result.reason
    assert validate(result.plan, domain, problem) == ""
    assert parse_plan(format_links(result.plan)) == result.plan
    return result


ROUTES = """(define (domain routes) (:requirements :typing :durative-actions :fluents) (:types place van)
  (:predicates (at ?v - van ?p - place)) (:functions (hours ?a ?b - place))
  (:durative-action drive :parameters (?v - van ?a ?b - place) :duration (= ?duration (hours ?a ?b))
    :condition (at start (at ?v ?a)) :effect (and (at start (not (at ?v ?a))) (at end (at ?v ?b)))))"""
TOWNS = """(define (problem towns) (:domain routes) (:objects v - van x y z - place)
  (:init (at v x) (= (hours x y) 1) (= (hours y z) 2) (= (hours x z) 9)) (:goal (at v z)))"""


def test_a_duration_that_depends_on_two_parameters_binds_these_and_nothing_else():
    result = planned(ROUTES, TOWNS)
    assert [(step.action, step.duration) for step in result.plan.steps] == [(("drive", "v", "x", "z"), 9)]


def test_action_cost_by_duration_counts_the_objects_chosen():
    result = planned(ROUTES, TOWNS, Settings(ground=False, action_cost="duration"))
    assert [(step.action[2:], step.duration) for step in result.plan.steps] == [(("x", "y"), 1), (("y", "z"), 2)]


def test_journeys_without_a_duration_are_impossible():
    domain, problem = read(
        ROUTES, TOWNS.replace("(at v x)", "(at v z)").replace("(:goal (at v z))", "(:goal (at v x))")
    )
    assert solve(domain, problem, LIFTED).status == "unsolvable"


PEOPLE = """(define (domain people) (:requirements :adl) (:types person key door)
  (:constants ben - person red blue - key)
  (:predicates (fits ?k - key ?d - door) (has ?p - person ?k - key) (open ?d - door) (greeted ?p - person) (party))
  (:action give :parameters (?p ?q - person ?k - key) :precondition (and (has ?p ?k) (not (= ?p ?q)))
    :effect (and (has ?q ?k) (not (has ?p ?k))))
  (:action unlock :parameters (?p - person ?d - door)
    :precondition (exists (?k - key) (and (fits ?k ?d) (has ?p ?k))) :effect (open ?d))
  (:action greet :parameters (?p - person) :effect (greeted ?p))
  (:action start :parameters () :precondition {start} :effect (party)))"""
PARTY = """(define (problem eve) (:domain people) (:objects ann - person front back - door)
  (:init (fits red front) (fits blue back) (has ann red) (has ben blue)) (:goal {goal}))"""


def party(goal, start="()"):
    result = planned(PEOPLE.replace("{start}", start), PARTY.replace("{goal}", goal))
    return [" ".join(step.action) for step in result.plan.steps], result.plan


def test_exists_brings_a_variable_that_is_bound_with_the_plan():
    actions, plan = party("(open back)")
    assert actions == ["unlock ben back"]
    assert {str(link.literal) for link in plan.links_to(1)} == {"(fits blue back)", "(has ben blue)"}
    assert any("== blue" in line for line in plan.bindings)


def test_exists_in_a_goal_joins_its_parts():
    actions, _ = party("(exists (?p - person ?k - key) (and (greeted ?p) (has ?p ?k) (fits ?k front)))")
    assert actions == ["greet ann"]


def test_equalities_in_disjunctions_bind_or_separate():
    start = "(exists (?p - person) (and (greeted ?p) (or (= ?p ben) (has ?p blue))))"
    assert party("(party)", start)[0] == ["greet ben", "start"]
    apart = "(exists (?p - person) (and (greeted ?p) (imply (has ?p red) (= ?p ben))))"
    assert party("(and (party) (not (greeted ben)))", apart)[0][-1] == "start"


def test_forall_is_spelled_out_over_the_objects():
    actions, _ = party("(party)", "(forall (?p - person) (or (greeted ?p) (has ?p blue)))")
    assert actions == ["greet ann", "start"]


def test_a_goal_that_no_binding_meets_is_unsolvable():
    domain, problem = read(PEOPLE.replace("{start}", "()"), PARTY.replace("{goal}", "(and (party) (= ann ben))"))
    assert solve(domain, problem, LIFTED).status == "unsolvable"


SHELF = """(define (domain shelf) (:requirements :adl) (:predicates (on ?b ?s) (full ?s) (wobbly ?s) (fallen ?b) (tidy))
  (:action put :parameters (?b ?s) :effect (on ?b ?s))
  (:action shake :parameters (?s)
    :effect (and (tidy) (forall (?b) (when (wobbly ?s) (and (fallen ?b) (not (on ?b ?s)))))))
  (:action fix :parameters (?s) :precondition (wobbly ?s) :effect (not (wobbly ?s))))"""


def test_a_threat_by_a_conditional_effect_is_separated_by_a_condition_that_fails_or_by_bindings():
    problem = """(define (problem p) (:domain shelf) (:objects book {shelves}) (:init (on book left) (wobbly left))
      (:goal (and (tidy) (on book left) (not (fallen book)))))"""
    one = planned(SHELF, problem.replace("{shelves}", "left"), Settings(("UCPOP", "ADD"), ground=False))
    assert [step.action[0] for step in one.plan.steps] == ["shake"]  # another object than the shelf is shaken
    only = problem.replace("book {shelves}", "left").replace("on book left", "on left left").replace("book", "left")
    result = planned(SHELF, only)
    assert [step.action[0] for step in result.plan.steps] == ["fix", "shake"]
    assert "(not (wobbly left))" in {str(link.literal) for link in result.plan.links}


def test_a_deletion_that_its_own_step_may_undo_binds_the_two_alike():
    domain = """(define (domain swap) (:requirements :adl) (:predicates (p ?x) (done))
      (:action move :parameters (?x ?y) :effect (and (not (p ?x)) (p ?y) (done))))"""
    problem = "(define (problem p) (:domain swap) (:objects a) (:init (p a)) (:goal (and (done) (p a))))"
    assert [step.action for step in planned(domain, problem).plan.steps] == [("move", "a", "a")]


def test_random_open_conditions_shuffle_lifted_steps_as_well():
    settings = [Settings(ground=False, random_open_conditions=True, seed=seed) for seed in (0, 0, 1, 2, 3)]
    results = [solve(*own("kitchen-s1"), chosen) for chosen in settings]
    assert results[0] == results[1]
    assert len({result.generated for result in results}) > 1
    assert all(validate(result.plan, *own("kitchen-s1")) == "" for result in results)


def test_thousands_of_variables_may_be_left_to_choose():
    choices = {(f"?v{n}", 1): ["a", "b"] for n in range(1500)}
    completed = next(Bindings().with_variables(choices).separated(("?v0", 1), ("?v1", 1)).completions())
    assert (completed.value(("?v0", 1)), completed.value(("?v1", 1)), completed.value(("?v1499", 1))) == ("a", "b", "a")


def test_variables_that_have_too_few_objects_to_differ_have_no_completion():
    names = [("?x", 1), ("?y", 1), ("?z", 2)]
    bindings = Bindings().with_variables({name: ["a", "b"] for name in names})
    for left, right in ((0, 1), (0, 2), (1, 2)):
        assert next(bindings.completions(), None) is not None
        bindings = bindings.separated(names[left], names[right])
    assert next(bindings.completions(), None) is None


WIDE = "(define (domain wide) (:predicates (p ?a ?b ?c) (q)) (:action a :parameters (?x) :effect {}))"
BOMBS = {
    "negative conditions over everything": (
        "(and (q) (not (p ?x ?x ?x)))",
        "(exists (?a ?b ?c) (and (not (p ?a ?b ?c)) (not (p ?b ?a ?c))))",
    ),
    "universal effects": ("(forall (?a ?b ?c) (when (not (p ?a ?b ?x)) (p ?a ?b ?c)))", "(q)"),
    "universal goal": ("(forall (?a ?b) (when (q) (p ?a ?b ?x)))", "(forall (?a ?b ?c) (p ?a ?b ?c))"),
}


@pytest.mark.parametrize("name", BOMBS)
@pytest.mark.parametrize("count", [20, 30, 200])
def test_bombs_for_lifted_planning_end_in_a_limit_within_a_second(name, count):
    effect, goal = BOMBS[name]
    objects = " ".join(f"o{n}" for n in range(count))
    problem = f"(define (problem x) (:domain wide) (:objects {objects}) (:init) (:goal {goal}))"
    task = read(WIDE.replace("{}", effect), problem)

    def explode():
        assert solve(*task, Settings(ground=False, node_limit=100)).status in ("limit", "unsolvable")

    assert standard_cpu_s(explode) < 1.0


def test_repeated_conditions_are_one_open_condition():
    domain = """(define (domain d) (:predicates (p ?x) (q)) (:durative-action a :parameters (?x)
      :duration (= ?duration 1) :condition (and {}) :effect (at end (p ?x))))"""
    problem = "(define (problem x) (:domain d) (:objects o) (:init (q)) (:goal (and {})))"
    counts = set()
    for times in (1, 50):
        texts = domain.format("(at start (q)) " * times), problem.format("(p o) " * times)
        result = solve(*read(*texts), Settings(ground=False))
        assert result.status == "solved"
        counts.add((result.generated, result.visited))
    assert len(counts) == 1
