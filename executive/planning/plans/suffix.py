"""The suffix of a plan: its remaining steps, linked anew from the current state, if they still reach the goal."""

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
    """The remaining steps of a plan, as a plan from the current state.

    Args:
      plan: The last plan.
      done: Ids of the executed steps.
      domain: The problem's domain.
      problem: Problem with the current facts as initial state, and the current goal.

    Returns:
      The remaining steps with their ids, links from the new initial state, the old orderings among them and those
      that the links require; None if they do not reach the goal from there.
    """
    left = tuple(step for step in plan.steps if step.id not in done)
    return relink(replace(plan, steps=_shifted(left, plan), links=(), bounds=(), bindings=()), domain, problem)


def relink(plan: Plan, domain: Domain, problem: Problem) -> Plan | None:
    """The plan with links and orderings rebuilt by simulating its steps in order.

    Args:
      plan: Steps in order; its links are ignored, its orderings kept.
      domain: The problem's domain.
      problem: Initial state and goal.

    Returns:
      The linked plan; None if it is unsound.
    """
    bare = replace(plan, problem=problem.name, initial=problem.initial, links=())
    if validate(bare, domain, problem):
        return None
    links = tuple(links_of(bare, domain, problem))
    kept = {step.id for step in plan.steps}
    old = [(i, j) for i, j in plan.orderings if i in kept and j in kept]
    orderings = closure([*old, *orderings_for(bare, links, domain, problem)])
    steps = bare.steps
    if not plan.durative:
        starts = levels([step.id for step in steps], orderings)
        assert starts is not None  # all pairs agree with the order of the steps
        steps = tuple(sorted((replace(s, start=starts[s.id]) for s in steps), key=lambda s: s.start))
    position = {step.id: n for n, step in enumerate(steps)}
    links = tuple(sorted(links, key=lambda link: position.get(link.consumer, len(steps))))
    linked = replace(bare, steps=steps, links=links, orderings=orderings)
    return None if validate(linked, domain, problem) else linked


def _shifted(steps: tuple[Step, ...], plan: Plan) -> tuple[Step, ...]:
    """A durative plan's remaining steps, shifted so that the first starts after one tick."""
    if not plan.durative or not steps:
        return steps
    shift = steps[0].start - plan.tick_s
    return tuple(replace(step, start=round(step.start - shift, 9)) for step in steps)
