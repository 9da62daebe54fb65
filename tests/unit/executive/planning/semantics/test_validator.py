"""The step simulator: sound plans pass, each kind of fault is found; and what is left of a plan is linked anew."""

import dataclasses

import pytest

from tailor.executive.planning import GOAL, Link, Literal, Settings, completed, parse_plan, relink, suffix, validate
from tests.support.planning.planning_problems import OWN, own, read, solve


def changed(plan, position, **changes):
    steps = list(plan.steps)
    steps[position] = dataclasses.replace(steps[position], **changes)
    return dataclasses.replace(plan, steps=tuple(sorted(steps, key=lambda step: step.start)))


@pytest.fixture
def kitchen():
    domain, problem = own("kitchen-s1")
    return solve(domain, problem).plan, domain, problem


@pytest.fixture
def soccer():
    domain, problem = own("soccer-durative-p1")
    return solve(domain, problem).plan, domain, problem


def test_a_sound_plan_passes(kitchen, soccer):
    assert validate(*kitchen) == validate(*soccer) == ""


@pytest.mark.parametrize(
    ("action", "fault"),
    [
        (("fly", "dock"), "the domain has no action 'fly'"),
        (("grip", "cup1"), "'grip' takes 2 arguments, not 1"),
        (("grip", "cup1", "cup1"), "'cup1' is no place"),
        (("grip", "cup1", "table2"), "(grip cup1 table2) lacks a condition at its start"),
    ],
)
def test_a_wrong_action_is_found(kitchen, action, fault):
    plan, domain, problem = kitchen
    assert fault in validate(changed(plan, 1, action=action), domain, problem)


@pytest.mark.parametrize("start_s", [-0.01, float("-inf")])
def test_a_start_before_the_initial_state_is_found(soccer, start_s):
    plan, domain, problem = soccer
    fault = validate(changed(plan, 0, start=start_s), domain, problem)
    assert fault.endswith(f"starts at {start_s} s, before the initial state")


def test_a_missed_goal_is_found(kitchen):
    plan, domain, problem = kitchen
    short = dataclasses.replace(plan, steps=plan.steps[:-1], links=())
    assert "the goal (and (cup-at cup1 table2)) does not hold" in validate(short, domain, problem)


def test_another_initial_state_makes_the_plan_unsound(kitchen):
    plan, domain, problem = kitchen
    assert validate(plan, domain, problem.with_initial([("robot-at", "dock"), ("hand-empty",)])) != ""


@pytest.mark.parametrize(
    ("link", "fault"),
    [
        (Link(9, Literal(("hand-empty",)), 2), "names a step that is not in the plan"),
        (Link(1, Literal(("hand-empty",)), 2), "runs backward in time"),
        (Link(3, Literal(("hand-empty",)), 2), "step 3 does not achieve it"),
        (Link(0, Literal(("holding", "cup1")), 2), "the literal does not hold initially"),
    ],
)
def test_a_causal_link_that_supports_nothing_is_found(kitchen, link, fault):
    plan, domain, problem = kitchen
    assert fault in validate(dataclasses.replace(plan, links=(*plan.links, link)), domain, problem)


@pytest.mark.parametrize(
    ("position", "changes", "fault"),
    [
        (0, {"duration": 2.0}, "cannot last 2.0 s"),
        (1, {"start": 2.5}, "loses a condition that it needs all the time"),
        (3, {"start": 5.0}, "lacks a condition at its start"),
    ],
)
def test_wrong_times_are_found(soccer, position, changes, fault):
    plan, domain, problem = soccer
    assert fault in validate(changed(plan, position, **changes), domain, problem)


FLASH = """(define (domain flash) (:requirements :durative-actions) (:predicates (on) (burnt) (g))
  (:durative-action flash :parameters () :duration (= ?duration 0)
    :condition (over all (on)) :effect (and (at start (on)) (at end (g))))
  (:durative-action burn :parameters () :duration (= ?duration 0)
    :condition (over all (or (not (burnt)) (not (on)))) :effect (and (at start (burnt)) (at start (on)))))"""


@pytest.mark.parametrize("ground", [True, False])
def test_the_start_of_a_step_that_takes_no_time_supports_the_step_itself(ground):
    domain, problem = read(FLASH, "(define (problem p) (:domain flash) (:init) (:goal (g)))")
    plan = solve(domain, problem, Settings(ground=ground)).plan
    assert Link(1, Literal(("on",)), 1) in plan.links
    assert validate(plan, domain, problem) == ""


def test_of_a_step_that_takes_no_time_a_condition_over_all_may_fail_and_has_no_link():
    domain, problem = read(FLASH, "(define (problem p) (:domain flash) (:init) (:goal (burnt)))")
    plan = completed(parse_plan("1: (burn) [0]"), domain, problem)
    assert plan.links == (Link(1, Literal(("burnt",)), GOAL),)
    assert validate(plan, domain, problem) == ""


def test_simultaneous_events_that_disturb_each_other_are_found():
    domain, problem = read(
        """(define (domain pair) (:requirements :durative-actions) (:predicates (p) (a) (b))
          (:durative-action take :parameters () :duration (= ?duration 1)
            :condition (at start (p)) :effect (and (at start (not (p))) (at end (a))))
          (:durative-action look :parameters () :duration (= ?duration 1)
            :condition (at start (p)) :effect (at end (b))))""",
        "(define (problem p) (:domain pair) (:init (p)) (:goal (and (a) (b))))",
    )
    plan = solve(domain, problem).plan
    assert validate(plan, domain, problem) == ""
    together = dataclasses.replace(plan, steps=tuple(dataclasses.replace(s, start=1.0) for s in plan.steps), links=())
    assert "disturbs" in validate(together, domain, problem)


LAMP = """(define (domain lamp) (:requirements :durative-actions :duration-inequalities) (:predicates (on) (dim) (off))
  (:durative-action look :parameters () :duration {}
    :condition (and (over all (on)) (at end (on))) :effect (and (at start (on)) (at end (dim))))
  (:durative-action hide :parameters () :duration (= ?duration 1) :condition (at start (dim))
    :effect (and (at start (not (on))) (at end (off)))))"""
DARK = "(define (problem p) (:domain lamp) (:init (on)) (:goal (and (dim) (off))))"


def test_what_lasts_no_time_needs_nothing_afterwards():
    lamp = LAMP.replace("{}", "(= ?duration 0)")
    plan = parse_plan(";p\n1:(look)[0]\n2:(hide)[1]\n")
    assert validate(plan, *read(lamp.replace("(at start (on))", ""), DARK)) == ""
    assert "disturbs" in validate(plan, *read(lamp, DARK))  # its end reads what its start adds at the same time


def test_what_may_take_time_takes_a_tick():
    domain, problem = read(LAMP.replace("{}", "(<= ?duration 5)"), DARK)
    for ground in (True, False):
        plan = solve(domain, problem, Settings(ground=ground)).plan
        assert validate(plan, domain, problem) == ""
        assert next(step.duration for step in plan.steps if step.action == ("look",)) == pytest.approx(0.01)


def test_making_true_what_is_true_disturbs_nobody():
    domain, problem = read(LAMP.replace("{}", "(= ?duration 1)"), DARK)
    plan = parse_plan(";p\n1:(look)[1]\n1:(look)[1]\n3:(hide)[1]\n")
    assert validate(plan, domain, problem) == ""


def test_an_event_that_adds_what_another_reads_disturbs_it_even_if_it_holds():
    domain, problem = read(LAMP.replace("{}", "(= ?duration 1)"), DARK)
    assert "disturbs" in validate(parse_plan(";p\n1:(look)[1]\n2:(look)[1]\n4:(hide)[1]\n"), domain, problem)


def test_a_disjunction_is_disturbed_though_another_way_still_meets_it():
    domain, problem = read(
        """(define (domain pair) (:requirements :adl :durative-actions) (:predicates (p) (q) (a) (b) (c))
          (:durative-action take :duration (= ?duration 1) :effect (and (at start (not (p))) (at end (a))))
          (:durative-action drop :duration (= ?duration 1) :effect (and (at start (not (q))) (at end (b))))
          (:durative-action look :parameters () :duration (= ?duration 1)
            :condition (at start (or (p) (q))) :effect (at end (c))))""",
        "(define (problem p) (:domain pair) (:init (p) (q)) (:goal (c)))",
    )
    assert "disturbs" in validate(parse_plan(";p\n1:(take)[1]\n1:(look)[1]\n"), domain, problem)
    assert validate(parse_plan(";p\n1:(take)[1]\n1.01:(look)[1]\n"), domain, problem) == ""


# --- what is left of a plan ----------------------------------------------------------------------
def after(plan, domain, problem, count):
    """The problem after the first steps of a plan without durations."""
    facts = dict.fromkeys(problem.initial)
    for step in plan.steps[:count]:
        action = next(a for a in domain.actions if a.name == step.action[0])
        names = dict(zip((p.name for p in action.parameters), step.action[1:], strict=True))
        for positive in (False, True):
            for effect in action.effects:
                fact = (effect.atom.predicate, *(names.get(t, t) for t in effect.atom.terms))
                if effect.positive == positive:
                    facts.update({fact: None}) if positive else facts.pop(fact, None)
    return problem.with_initial(facts)


@pytest.mark.parametrize("name", [name for name in OWN if "durative" not in name])
def test_the_suffix_of_a_plan_is_sound_after_every_step(name):
    domain, problem = own(name)
    plan = solve(domain, problem).plan
    for count in range(len(plan.steps) + 1):
        now = after(plan, domain, problem, count)
        rest = suffix(plan, {step.id for step in plan.steps[:count]}, domain, now)
        assert [step.action for step in rest.steps] == [step.action for step in plan.steps[count:]] or count == 0
        assert {step.id for step in rest.steps} == {step.id for step in plan.steps[count:]}
        assert rest.initial == now.initial
        assert validate(rest, domain, now) == ""
        assert rest.links_to(GOAL)


def test_links_of_a_suffix_come_from_the_state_of_now(kitchen):
    plan, domain, problem = kitchen
    now = after(plan, domain, problem, 2)
    rest = suffix(plan, {3, 2}, domain, now)
    assert Link(0, Literal(("holding", "cup1")), 1) in rest.links
    assert Link(0, Literal(("robot-at", "table1")), 4) in rest.links
    assert rest.orderings == ((4, 1),)
    assert [step.start for step in rest.steps] == [1, 2]


def test_a_suffix_that_no_longer_reaches_the_goal_is_none(kitchen):
    plan, domain, problem = kitchen
    assert suffix(plan, {3}, domain, problem) is None  # navigation was done, but the robot is still at the dock


def test_the_durative_suffix_starts_a_tick_from_now(soccer):
    plan, domain, problem = soccer
    left = [fact for fact in problem.initial if fact[0] != "robot-at"]
    rest = suffix(plan, {4}, domain, problem.with_initial([*left, ("robot-at", "r1", "p2")]))
    assert [step.action[0] for step in rest.steps] == ["approachball", "dribbleball", "dribbleball"]
    assert rest.steps[0].start == pytest.approx(0.01)
    assert rest.orderings == ((1, 1),)[:0] + tuple(sorted({(3, 2), (3, 1), (2, 1)}))


def test_a_goal_of_disjunctions_and_negations_is_linked_to_what_makes_it_true(kitchen):
    plan, domain, problem = kitchen
    wider = problem.with_goal("(and (or (holding cup1) (cup-at cup1 table2)) (not (robot-at dock)))")
    linked = relink(plan, domain, wider)
    assert {(link.producer, str(link.literal)) for link in linked.links_to(GOAL)} == {
        (1, "(cup-at cup1 table2)"),
        (3, "(not (robot-at dock))"),
    }
