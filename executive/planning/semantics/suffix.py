"""The suffix of a plan: its remaining steps, linked anew from the current state, if they still reach the goal."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import GOAL, Link, Plan, Step, by_consumer
from tailor.executive.planning.plans.portions import Work, completed_work
from tailor.executive.planning.plans.schedule import closure, scheduling
from tailor.executive.planning.semantics.links import linking, orderings_for
from tailor.executive.planning.semantics.regression import Regression
from tailor.executive.planning.semantics.state import MAX_PARTS, Objects, TooLargeError
from tailor.executive.planning.semantics.validator import validation


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
    return completed_work(relinking(_with_steps(plan, left), domain, Objects(problem)))


def shortest_suffix(plan: Plan, done: Collection[int], domain: Domain, problem: Problem) -> Work[Plan | None]:
    """The shortest suffix of a plan that is sound now; steps whose effects hold already are left out.

    Args:
      plan: The last plan.
      done: Ids of the executed steps.
      domain: The problem's domain.
      problem: Problem with the current facts as initial state, and the current goal.

    Returns:
      As `suffix`; None if not even all the remaining steps reach the goal, or there is too much to check.
    """
    try:
        return (yield from _shortest(plan, done, domain, Objects(problem, MAX_PARTS)))
    except TooLargeError:
        return None


def _shortest(plan: Plan, done: Collection[int], domain: Domain, objects: Objects) -> Work[Plan | None]:
    problem = objects.problem
    left = tuple(step for step in plan.steps if step.id not in done)
    needs = Regression(domain, objects)
    for first in range(len(left), -1, -1):
        if first < len(left):
            yield from needs.add(left[first])
            yield
        if not needs.possible:
            return None
        if not needs.reached:
            continue
        bare = _located(_with_steps(plan, left[first:]), problem)
        if needs.exact and left == plan.steps[len(plan.steps) - len(left) :]:
            found = yield from _with_own_links(plan, bare, needs, domain, objects)
            if found is not None:
                return found
        if needs.exact or not (yield from validation(bare, domain, objects)):
            found = yield from _linked(bare, plan.orderings, domain, objects)
            if found is not None:
                return found
    return None


def relink(plan: Plan, domain: Domain, problem: Problem) -> Plan | None:
    """The plan with links and orderings rebuilt by simulating its steps in order.

    Args:
      plan: Steps in order; its links are ignored, its orderings kept.
      domain: The problem's domain.
      problem: Initial state and goal.

    Returns:
      The linked plan; None if it is unsound.
    """
    return completed_work(relinking(plan, domain, Objects(problem)))


def relinking(plan: Plan, domain: Domain, objects: Objects) -> Work[Plan | None]:
    """`relink` in portions, with the objects and initial state of the problem."""
    bare = _located(plan, objects.problem)
    if (yield from validation(bare, domain, objects)):
        return None
    return (yield from _linked(bare, plan.orderings, domain, objects))


def _with_own_links(plan: Plan, bare: Plan, needs: Regression, domain: Domain, objects: Objects) -> Work[Plan | None]:
    """The last steps of a plan with its own links, those from earlier steps from the initial state; None if unsound.

    What protected a link still does, as no step that comes before its producer is left.
    """
    kept = {step.id for step in bare.steps}
    producers = {(link.consumer, link.literal): link.producer for link in plan.links}
    links: list[Link] = []
    for consumer in (*(step.id for step in bare.steps), GOAL):
        for literal in reversed(needs.required[consumer]):
            producer = producers.get((consumer, literal))
            if producer is None:
                return None
            links.append(Link(producer if producer in kept else 0, literal, consumer))
        yield
    return (yield from _scheduled(bare, tuple(links), plan.orderings, domain, objects))


def _linked(bare: Plan, old: tuple[tuple[int, int], ...], domain: Domain, objects: Objects) -> Work[Plan | None]:
    """A sound plan with links, the old orderings of its steps and the required ones; None if that is unsound."""
    links = yield from linking(bare, domain, objects)
    required = yield from orderings_for(bare, links, domain, objects)
    return (yield from _scheduled(bare, links, [*old, *required], domain, objects))


def _scheduled(
    bare: Plan, links: tuple[Link, ...], pairs: Iterable[tuple[int, int]], domain: Domain, objects: Objects
) -> Work[Plan | None]:
    """The plan with links, and orderings of its steps, which get the levels that these require; None if unsound."""
    steps = bare.steps
    kept = {step.id for step in steps}
    pairs = [(i, j) for i, j in pairs if i in kept and j in kept]
    if bare.durative:
        orderings = closure(pairs)
    else:  # all pairs agree with the order of the steps
        starts, orderings = yield from scheduling([step.id for step in steps], pairs)
        steps = tuple(sorted((replace(s, start=starts[s.id]) for s in steps), key=lambda s: s.start))
    linked = replace(bare, steps=steps, links=by_consumer(links, steps), orderings=orderings)
    yield
    return None if (yield from validation(linked, domain, objects)) else linked


def _located(plan: Plan, problem: Problem) -> Plan:
    """The plan as one of that problem, without links."""
    return replace(plan, problem=problem.name, initial=problem.initial, links=())


def _with_steps(plan: Plan, steps: tuple[Step, ...]) -> Plan:
    """The plan with those of its steps alone, without links; of a durative plan the first starts after one tick."""
    if plan.durative and steps:
        shift = steps[0].start - plan.tick_s
        steps = tuple(replace(step, start=round(step.start - shift, 9)) for step in steps)
    return replace(plan, steps=steps, links=(), bounds=(), bindings=())
