"""Clauses that concern each scenario: drawing, belief, planning, instantiation."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tailor.executive import planning
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.domain import Scenario
from tailor.executive.interfaces.values import Belief
from tailor.executive.refinement.instantiation import instantiate
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.tools.contract.clause import clause
from tailor.tools.contract.subject import Subject

CHECKS = 2000  # of the planner


@clause("scenario")
def scenarios_follow_the_seed(subject: Subject, case: str) -> Iterator[str]:
    """Equal random generators draw equal scenarios."""
    if subject.scenario(case, 1) != subject.scenario(case, 1):
        yield "two draws with the same seed differ: every draw must come from rng"


@clause("scenario")
def scenarios_are_finite(subject: Subject, case: str) -> Iterator[str]:
    """Start and places are finite numbers."""
    drawn, start = subject.scenario(case, 2)
    values = {**start, **{f"{p}.{q}": v for p, place in drawn.places.items() for q, v in place.items()}}
    yield from (f"{name} is {value}" for name, value in values.items() if not math.isfinite(value))


@clause("scenario", needs="body")
def belief_becomes_ready(subject: Subject, case: str) -> Iterator[str]:
    """After three seconds of looking around the belief is ready."""
    _, start = subject.scenario(case, 0)
    belief, _ = subject.look(start)
    if not subject.domain.ready(belief):
        yield "ready is false after 3 s at rest"


@clause("scenario", needs="body")
def belief_values_are_finite(subject: Subject, case: str) -> Iterator[str]:
    """`belief_values` are finite, for the first or all of `belief_names`, before and after percepts."""
    domain = subject.domain
    _, start = subject.scenario(case, 0)
    for when, belief in (("first", domain.initial_belief()), ("after percepts", subject.look(start)[0])):
        values = domain.belief_values(belief)
        if not 0 < len(values) <= len(domain.belief_names):
            yield f"{when}: {len(values)} belief_values, expected at most {len(domain.belief_names)} by belief_names"
        elif not np.isfinite(values).all():
            yield f"{when}: belief_values are {values}"


@clause("scenario", needs="body")
def scenarios_can_be_planned(subject: Subject, case: str) -> Iterator[str]:
    """From what is believed at the start, the planner finds a plan."""
    if _planned(subject, case)[0] is None:
        yield f"no plan after {CHECKS} checks"


@clause("scenario", needs="body")
def plans_can_be_instantiated(subject: Subject, case: str) -> Iterator[str]:
    """The plan becomes executable actions, whose variables have finite ranges."""
    sequence = _sequence(subject, case)
    if isinstance(sequence, Failure):
        yield f"{sequence}"
    elif sequence is not None:
        for variable in sequence.variables:
            if not (math.isfinite(variable.lower) and math.isfinite(variable.upper)):
                yield f"{variable.quantity} of {variable.label} ranges from {variable.lower} to {variable.upper}"


@clause("scenario", needs="body")
def something_is_free(subject: Subject, case: str) -> Iterator[str]:
    """The plan leaves a parameter free, or an action may get a subgoal: else there is nothing to refine."""
    sequence = _sequence(subject, case)
    if not isinstance(sequence, ActionSequence):
        return
    free = any(variable.value is None for variable in sequence.variables)
    if not free and not any(action.action.subgoal_action for action in sequence.actions):
        yield "every parameter is bound, and no action has a subgoal_action"


def _sequence(subject: Subject, case: str) -> ActionSequence | Failure | None:
    """The plan as executable actions, or why there are none; None without a plan."""
    plan, belief, drawn = _planned(subject, case)
    return None if plan is None else instantiate(plan, subject.domain, belief, drawn)


def _planned(subject: Subject, case: str) -> tuple[planning.Plan | None, Belief, Scenario]:
    """The plan from the abstract state as anchored in the belief at the start, with both."""
    domain, (drawn, start) = subject.domain, subject.scenario(case, 0)
    belief, _ = subject.look(start)
    pddl = planning.parse_domain(domain.pddl)
    problem = planning.parse_problem(drawn.problem, pddl)
    facts = domain.anchor(belief, drawn, frozenset(problem.initial))
    result = planning.Search(pddl, problem.with_initial(facts)).advance(CheckBudget(CHECKS))
    return None if result is None else result.plan, belief, drawn
