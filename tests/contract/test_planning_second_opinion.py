"""A second opinion: the independent validator of kairos-planner accepts our plans and refuses what ours refuses."""

import dataclasses
from datetime import timedelta

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tailor.executive import domains
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.planning import DEFAULT, MATCHING, AnytimeSearch, Settings, format_plan, format_problem, validate
from tailor.schemas.installed import domain_names
from tests.contract.random_temporal import random_task
from tests.support.planning.planning_problems import DATA, OWN, SHARED, read, solve
from tests.unit.executive.planning.pddl.test_language import IRON, TIMED, WORKSHOP

kairos = pytest.importorskip("kairos", reason="kairos-planner is not installed: no second opinion")

TEXTS = {
    name: [(DATA / "own" / f"{stem}.pddl").read_text() for stem in (f"{name.rsplit('-', 1)[0]}-domain", name)]
    for name in OWN
}
TEXTS |= {"window": [WORKSHOP, TIMED], "workshop": [WORKSHOP, IRON.replace("{more}", "")]}
for path in sorted((SHARED / "ipc" / "satellite-simpletime").glob("p0[1-4].pddl")):
    TEXTS[f"satellite-{path.stem}"] = [(path.parent / "domain.pddl").read_text(), path.read_text()]


def accepted(texts, plan):
    """Whether kairos finds the plan sound."""
    domain = kairos.parse_domain(texts[0])
    lines = (line for line in format_plan(plan).splitlines() if not line.startswith(";"))
    text = "\n".join(line.replace(":(", ": (").replace(")[", ") [") for line in lines)
    return kairos.validate(kairos.parse_problem(texts[1], domain), kairos.parse_plan(text)).valid


@pytest.mark.parametrize("options", [MATCHING, DEFAULT, Settings(ground=False, node_limit=400)])
@pytest.mark.parametrize("name", TEXTS)
def test_our_plans_are_sound_in_anothers_eyes(name, options):
    result = solve(*read(*TEXTS[name]), options)
    if result.plan is None:
        assert (result.status, options.ground) == ("limit", False)  # too much for lifted planning
    else:
        assert accepted(TEXTS[name], result.plan)


@pytest.mark.parametrize("name", [name for name in TEXTS if "durative" in name])
def test_both_refuse_the_same_plans(name):
    domain, problem = read(*TEXTS[name])
    plan = dataclasses.replace(solve(domain, problem).plan, links=())
    for number, step in enumerate(plan.steps):
        for start in (step.start - 3, step.start - 0.5, step.start + 0.005, step.start + 2):
            if start > 0:
                moved = dataclasses.replace(step, start=start)
                steps = sorted([*plan.steps[:number], moved, *plan.steps[number + 1 :]], key=lambda s: s.start)
                other = dataclasses.replace(plan, steps=tuple(steps))
                assert (validate(other, domain, problem) == "") == accepted(TEXTS[name], other), format_plan(other)


@pytest.mark.parametrize("name", [name for name in TEXTS if "durative" in name or "satellite" in name])
def test_every_better_plan_of_an_anytime_search_is_sound_in_anothers_eyes(name):
    domain, problem = read(*TEXTS[name])
    search = AnytimeSearch(domain, problem, Settings(engine="pocl", node_limit=1500))
    while not search.ended:
        result = search.advance(CheckBudget(1000))
        if result is not None:
            assert validate(result.plan, domain, problem) == ""
            assert accepted(TEXTS[name], result.plan)


# --- requests to an external planner ---------------------------------------------------------------
@pytest.mark.parametrize("name", TEXTS)
def test_a_problem_as_an_external_planner_gets_it_is_the_same_in_anothers_eyes(name):
    domain, problem = read(*TEXTS[name])
    assert accepted([TEXTS[name][0], format_problem(problem)], solve(domain, problem, DEFAULT).plan)


@pytest.mark.parametrize(("name", "scenario"), [(d, s) for d in domain_names() for s in domains.scenarios(d)[:8]])
def test_the_domains_that_ship_are_pddl_that_another_reads(name, scenario):
    texts = [domains.load(name).pddl, domains.seeded_scenario(name, scenario, 0)[0].problem]
    domain, problem = read(*texts)
    assert accepted([texts[0], format_problem(problem)], solve(domain, problem).plan)


# --- random actions with durations ---------------------------------------------------------------
LITERALS = st.sampled_from(["(p)", "(q)", "(r)", "(not (p))", "(not (r))"])
CONDITION = st.builds("({} {})".format, st.sampled_from(["at start", "over all", "at end"]), LITERALS)
EFFECT = st.builds("({} {})".format, st.sampled_from(["at start", "at end"]), LITERALS)
ACTION = st.builds(
    "(:durative-action a{} :parameters () :duration (and (>= ?duration {}) (<= ?duration 6))"
    " :condition (and {}) :effect (and {}))".format,
    st.integers(0, 10**9),
    st.integers(1, 6),
    st.lists(CONDITION, max_size=3).map(" ".join),
    st.lists(EFFECT, min_size=1, max_size=3).map(" ".join),
)
TASK = st.builds(
    lambda actions, initial, goal: [
        "(define (domain d) (:requirements :durative-actions :negative-preconditions :duration-inequalities)"
        f" (:predicates (p) (q) (r)) {' '.join(actions)})",
        f"(define (problem x) (:domain d) (:init {' '.join(initial)}) (:goal (and {' '.join(goal)})))",
    ],
    st.lists(ACTION, min_size=1, max_size=3, unique_by=lambda action: action.split()[1]),
    st.lists(st.sampled_from(["(p)", "(q)", "(r)"]), max_size=2, unique=True),
    st.lists(LITERALS, min_size=1, max_size=2),
)


@settings(max_examples=100, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(TASK)
def test_plans_of_random_durative_actions_are_sound_in_both_eyes(texts):
    domain, problem = read(*texts)
    for ground in (True, False):
        result = solve(domain, problem, Settings(node_limit=150, ground=ground))
        if result.plan is not None and result.plan.steps:
            assert validate(result.plan, domain, problem) == ""
            assert accepted(texts, result.plan), format_plan(result.plan)


BROKEN_ONCE = [0, 50, 168, 344, 384, 428, 484, 537, 582]  # plans with interfering events, false proofs
RANDOM_TASKS = [(seed, costs) for seed in {*range(30), *BROKEN_ONCE} for costs in (False, True)]


@pytest.mark.parametrize("ground", [True, False])
def test_both_agree_on_random_problems_with_time(ground):
    """Our plans are sound, and what no relaxed plan reaches is beyond the other planner as well."""
    statuses = set()
    for seed, costs in RANDOM_TASKS:
        texts, tick_s = random_task(seed, costs)
        result = solve(*(read(*texts)), Settings(node_limit=200, ground=ground, tolerance_s=tick_s))
        statuses.add(result.status)
        if result.plan is not None and result.plan.steps:
            assert validate(result.plan, *read(*texts)) == "", seed
            assert accepted(texts, result.plan), seed
        elif "without delete effects" in result.reason:
            domain = kairos.parse_domain(texts[0])
            other = kairos.solve(domain, kairos.parse_problem(texts[1], domain), timeout=timedelta(seconds=0.2))
            assert other.plan is None, seed
    assert statuses >= {"solved", "unsolvable"}


# --- exact time ------------------------------------------------------------------------------------
@pytest.mark.parametrize("tolerance_s", [0.001, 0.01, 0.25, 0.5, 1])
@pytest.mark.parametrize("duration", ["1.4", "3.14159", "0.125", "(/ 10 7)"])
def test_any_duration_and_tolerance_gives_plans_that_another_accepts(tolerance_s, duration):
    domain = f"""(define (domain d) (:requirements :durative-actions) (:predicates (p) (q) (r))
      (:durative-action first :parameters () :duration (= ?duration {duration}) :effect (at end (p)))
      (:durative-action second :parameters () :duration (= ?duration {duration})
        :condition (and (at start (p)) (over all (p))) :effect (and (at start (q)) (at end (r)) (at end (not (p))))))"""
    texts = [domain, "(define (problem x) (:domain d) (:init) (:goal (and (q) (r) (not (p)))))"]
    for ground in (True, False):
        plan = solve(*read(*texts), Settings(ground=ground, tolerance_s=tolerance_s)).plan
        assert accepted(texts, plan), format_plan(plan)
