"""Durative planning against brute force: what actions reach one after another is never called unsolvable."""

from itertools import product

import pytest
from hypothesis import HealthCheck, given, settings

from tailor.executive.planning import Settings, validate
from tailor.executive.planning.pddl.language import fact_of
from tailor.executive.planning.semantics.state import Objects, holds
from tests.property.test_planning_lifted import DURATIVE, tasks
from tests.support.planning.planning_problems import read, solve


def met(conditions, when, binding, state, objects):
    return all(holds(c.formula, binding, state, objects) for c in conditions if c.when == when)


def after(action, binding, state, objects):
    """The state when the action has begun and ended alone, or None where it cannot."""
    if not met(action.conditions, "start", binding, state, objects):
        return None
    begun = changed(action, binding, "start", state, state, objects)
    if not all(met(action.conditions, when, binding, begun, objects) for when in ("over", "end")):
        return None
    return changed(action, binding, "end", state, begun, objects)


def changed(action, binding, moment, first, now, objects):
    """The state with the effects of one moment; `first` is that before the action, additions win over deletions."""
    made = {True: set(), False: set()}
    for effect in action.effects:
        for inner in objects.bindings(effect.variables, binding) if effect.when == moment else ():
            if met(effect.condition, "start", inner, first, objects) and all(
                met(effect.condition, when, inner, now, objects) for when in ("over", "end")
            ):
                made[effect.positive].add(fact_of(effect.atom, inner))
    return (now - made[False]) | made[True]


def reachable(domain, problem):
    """Whether some sequence of actions, none at the same time as another, reaches the goal."""
    objects = Objects(problem)
    instances = [
        (action, dict(zip((p.name for p in action.parameters), names, strict=True)))
        for action in domain.actions
        for names in product(*(objects.of(p) for p in action.parameters))
    ]
    seen, pending = {frozenset(problem.initial)}, [frozenset(problem.initial)]
    while pending:
        state = pending.pop()
        if holds(problem.goal, {}, state, objects):
            return True
        new = {after(action, binding, state, objects) for action, binding in instances} - seen - {None}
        seen |= new
        pending += new
    return False


@pytest.mark.parametrize("ground", [True, False], ids=["ground", "lifted"])
def test_what_actions_reach_one_after_another_is_never_called_unsolvable(ground):
    verdicts = set()

    @settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
    @given(tasks(":durative-action", DURATIVE, windows=0))
    def check(texts):
        domain, problem = read(*texts)
        result = solve(domain, problem, Settings(node_limit=300, ground=ground))
        possible = reachable(domain, problem)
        verdicts.add((result.status, possible))
        assert (result.status, possible) != ("unsolvable", True), texts
        assert result.plan is None or validate(result.plan, domain, problem) == "", texts

    check()
    assert {("solved", True), ("unsolvable", False)} <= verdicts  # neither side of the promise is empty
