"""Completes a plan from another planner: the current facts, and the causal links that its text omits."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import Plan, by_consumer
from tailor.executive.planning.plans.portions import Work, completed_work
from tailor.executive.planning.plans.schedule import scheduled_bounds, scheduling
from tailor.executive.planning.semantics.links import linking, orderings_for
from tailor.executive.planning.semantics.state import MAX_PARTS, Objects, TooLargeError
from tailor.executive.planning.semantics.suffix import relinking
from tailor.executive.planning.semantics.validator import validation


def completed(plan: Plan, domain: Domain, problem: Problem) -> Plan | str:
    """The plan with a causal link for every condition.

    Existing links are kept. VHPOP omits links from static facts when it plans with ground actions: they are added,
    each step's newest. A plan that lacks others, such as the plain form, or orderings that its links require, is linked
    anew in the order of its steps.

    Args:
      plan: A parsed plan of any planner.
      domain: The problem's domain.
      problem: Problem with the current facts.

    Returns:
      The completed plan, or the reason why it is unsound.
    """
    return completed_work(completion(plan, domain, problem))


def completion(plan: Plan, domain: Domain, problem: Problem) -> Work[Plan | str]:
    """`completed` in portions."""
    try:
        return (yield from _completion(plan, domain, Objects(problem, MAX_PARTS)))
    except TooLargeError as reason:
        return str(reason)


def _completion(plan: Plan, domain: Domain, objects: Objects) -> Work[Plan | str]:
    problem = objects.problem
    located = _located(plan, domain, problem)
    fault = yield from validation(located, domain, objects)
    if fault:
        return fault
    supported = {(link.literal, link.consumer) for link in plan.links}
    needed = yield from linking(located, domain, objects)
    absent = [link for link in needed if (link.literal, link.consumer) not in supported]
    changing = problem.changing
    linked = replace(located, links=by_consumer((*absent, *plan.links), located.steps))
    keeps = located.steps == plan.steps and not any(link.literal.fact[0] in changing for link in absent)
    if not keeps or not (yield from _protects(linked, domain, objects)):
        anew = yield from relinking(located, domain, objects)
        if anew is None:
            return "its steps cannot be linked"
        linked = anew
    return linked if linked.bounds else replace(linked, bounds=scheduled_bounds(linked))


def _protects(plan: Plan, domain: Domain, objects: Objects) -> Work[bool]:
    """Whether the orderings of a plan without durations imply all that its links require."""
    if plan.durative:
        return True
    steps = [step.id for step in plan.steps]
    own = [(i, j) for i, j in plan.orderings if i in steps and j in steps]
    _, implied = yield from scheduling(steps, own)
    required = yield from orderings_for(plan, plan.links, domain, objects)
    return set(implied).issuperset(required)


def _located(plan: Plan, domain: Domain, problem: Problem) -> Plan:
    """The plan as one of the problem.

    An instantaneous action takes no time, whatever the other planner prints: then its orderings are not those printed.
    Beside timed literals a plan of such actions has times, though none of durations.
    """
    instant = {action.name for action in domain.actions if action.duration is None}
    durative = plan.durative or (bool(problem.timed) and all(step.action[0] in instant for step in plan.steps))
    timeless = instant if durative else set[str]()
    steps = tuple(replace(step, duration=0.0) if step.action[0] in timeless else step for step in plan.steps)
    plan = replace(plan, problem=problem.name, initial=problem.initial, durative=durative)
    return plan if steps == plan.steps else replace(plan, steps=steps, links=(), orderings=(), bounds=())
