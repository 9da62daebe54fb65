"""What is left of a plan: its remaining steps, linked anew from the state of now, if they still reach the goal."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.links import links_of, orderings_for
from tailor.executive.planning.plans.plan import Plan, Step
from tailor.executive.planning.plans.schedule import closure, levels
from tailor.executive.planning.plans.validator import validate


def suffix(plan: Plan, done: Collection[int], domain: Domain, problem: Problem) -> Plan | None:
    """The steps of a plan that are not done yet, as a plan of their own.

    Args:
      plan: The last plan.
      done: Ids of the steps that have been executed.
      domain: The problem's domain.
      problem: The problem from the initial state of now, with the goal of now.

    Returns:
      The remaining steps with their ids, links rebuilt from the new initial state, the old orderings among them and
      those that the links need; None when they do not reach the goal from here.
    """
    left = tuple(step for step in plan.steps if step.id not in done)
    return relink(replace(plan, steps=_from_now(left, plan), links=(), bounds=(), bindings=()), domain, problem)


def relink(plan: Plan, domain: Domain, problem: Problem) -> Plan | None:
    """The plan with causal links and orderings built by going through its steps in order; None when it is unsound."""
    bare = replace(plan, problem=problem.name, initial=problem.initial, links=())
    if validate(bare, domain, problem):
        return None
    links = tuple(links_of(bare, domain, problem))
    kept = {step.id for step in plan.steps}
    old = [(i, j) for i, j in plan.orderings if i in kept and j in kept]
    orderings = closure([*old, *orderings_for(bare, links, domain, problem)])
    steps = bare.steps
    if not plan.durative:
        found = levels([step.id for step in steps], orderings)
        assert found is not None  # all pairs go with the order of the steps
        steps = tuple(sorted((replace(s, start=found[s.id]) for s in steps), key=lambda s: s.start))
    position = {step.id: n for n, step in enumerate(steps)}
    links = tuple(sorted(links, key=lambda link: position.get(link.consumer, len(steps))))
    linked = replace(bare, steps=steps, links=links, orderings=orderings)
    return None if validate(linked, domain, problem) else linked


def _from_now(steps: tuple[Step, ...], plan: Plan) -> tuple[Step, ...]:
    """A durative plan's remaining steps, moved so that the first starts one tick from now."""
    if not plan.durative or not steps:
        return steps
    shift = steps[0].start - plan.tick_s
    return tuple(replace(step, start=round(step.start - shift, 9)) for step in steps)
