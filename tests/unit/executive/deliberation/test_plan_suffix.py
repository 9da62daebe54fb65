"""The shortest sound suffix of a plan is the one that trying all suffixes finds, from whatever state."""

from functools import cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tailor.executive.planning import (
    Settings,
    apply_action,
    format_excerpt,
    format_links,
    parse_plan,
    shortest_suffix,
    suffix,
    validate_every_order,
)
from tailor.executive.planning.plans.portions import completed_work
from tailor.executive.planning.semantics import suffix as plan_suffix
from tests.support.planning.planning_problems import many_cups, own, solve

PROBLEMS = ("kitchen-s2", "kitchen-reach-s2", "kitchen-durative-s2", "soccer-typed-p2", "cups")


@cache
def solved(name):
    domain, problem = many_cups(4) if name == "cups" else own(name)
    return domain, problem, solve(domain, problem, Settings()).plan


def by_trial(plan, done, domain, problem):
    """The shortest sound suffix, by validating all."""
    left = [step.id for step in plan.steps if step.id not in done]
    for skipped in range(len(left), -1, -1):
        found = suffix(plan, done | set(left[:skipped]), domain, problem)
        if found is not None:
            return found
    return None


@pytest.mark.parametrize("name", PROBLEMS)
@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_it_is_the_one_that_trying_all_finds(name, data):
    domain, problem, plan = solved(name)
    facts = set(problem.initial)
    for step in plan.steps[: data.draw(st.integers(0, len(plan.steps)))]:
        made = {link.literal.fact for link in plan.links if link.producer == step.id and link.literal.positive}
        facts |= made
        facts -= data.draw(st.sets(st.sampled_from(sorted(facts)), max_size=2))
    done = data.draw(st.sets(st.sampled_from([step.id for step in plan.steps]), max_size=4))
    now = problem.with_initial(sorted(facts))
    assert completed_work(shortest_suffix(plan, done, domain, now)) == by_trial(plan, done, domain, now)


@pytest.mark.parametrize("name", PROBLEMS)
def test_what_is_left_of_an_executed_plan_keeps_its_links_without_simulation(name, monkeypatch):
    domain, problem, plan = solved(name)
    facts = frozenset(problem.initial)
    for count, step in enumerate(plan.steps, 1):
        facts = apply_action(domain, problem, facts, step.action)
        done, now = {step.id for step in plan.steps[:count]}, problem.with_initial(sorted(facts))
        with monkeypatch.context() as without:
            if not plan.durative:
                without.delattr(plan_suffix, "linking")
            rest = completed_work(shortest_suffix(plan, done, domain, now))
        assert rest == by_trial(plan, done, domain, now)
        assert rest.durative or validate_every_order(rest, domain, now) == ""


def test_some_of_those_states_have_a_suffix_and_some_have_none():
    domain, problem, plan = solved("cups")
    first = plan.steps[0]
    assert completed_work(shortest_suffix(plan, {first.id}, domain, problem)) is None
    assert completed_work(shortest_suffix(plan, set(), domain, problem)).steps == plan.steps


@pytest.mark.parametrize("name", PROBLEMS)
def test_an_excerpt_of_a_short_plan_is_the_whole_plan_and_of_a_longer_one_its_beginning(name):
    _, _, plan = solved(name)
    assert format_excerpt(plan) == format_links(plan)
    excerpt = parse_plan(format_excerpt(plan, 3))
    assert [step.action for step in excerpt.steps] == [step.action for step in plan.steps[:3]]
    assert set(excerpt.links) <= set(plan.links)
