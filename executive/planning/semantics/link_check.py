"""Checks a plan's causal links: each producer makes its literal true, and comes before its consumer."""

from __future__ import annotations

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import Action, Effect
from tailor.executive.planning.plans.plan import GOAL, Link, Plan
from tailor.executive.planning.plans.portions import Work
from tailor.executive.planning.semantics.interference import names
from tailor.executive.planning.semantics.state import Binding, Objects

LINKS = 16  # as much work as the simulation of one step
Bound = dict[int, tuple[Action, Binding]]  # schema and binding of each step


def faulty_link(plan: Plan, objects: Objects, bound: Bound) -> Work[str]:
    """The first unsound causal link with the reason; "" if all are sound. One portion for `LINKS` of them."""
    starts = {0: -1.0, **{step.id: step.start for step in plan.steps}}
    deadlines = {step.id: step.start + (step.duration if plan.durative else 0) for step in plan.steps}
    for count, link in enumerate(plan.links, 1):
        fault = _fault(link, starts, deadlines, objects, bound)
        if fault:
            return f"the causal link {link.producer} -> {link.literal} {fault}"
        if not count % LINKS:
            yield
    return ""


def _fault(link: Link, starts: dict[int, float], deadlines: dict[int, float], objects: Objects, bound: Bound) -> str:
    """The fault of a link or ""; `deadlines` is the last time at which each step may require a condition."""
    if link.producer not in starts or (link.consumer != GOAL and link.consumer not in starts):
        return "names a step that is not in the plan"
    if link.consumer != GOAL and starts[link.producer] >= deadlines[link.consumer] and not _is_own(link, bound):
        return "runs backward in time"
    if link.producer == 0:
        timed = any(t.literal == link.literal for t in objects.problem.timed)
        holds = link.literal.holds_in(objects.initial)
        return "" if timed or holds else "supports nothing: the literal does not hold initially"
    action, binding = bound[link.producer]
    effects = [effect for effect in action.effects if effect.positive == link.literal.positive]
    if any(_touches(effect, binding, link.literal.fact, objects) for effect in effects):
        return ""
    return f"supports nothing: step {link.producer} does not achieve it"


def _is_own(link: Link, bound: Bound) -> bool:
    """Whether the start of a step with a duration, maybe of 0, supports a later condition of the step itself."""
    return link.producer == link.consumer and bound[link.producer][0].duration is not None


def _touches(effect: Effect, binding: Binding, fact: Fact, objects: Objects) -> bool:
    """Whether the effect is that fact for some of its objects: found without trying all, of which there may be many."""
    if len(effect.atom.terms) != len(fact) - 1 or not all(objects.of(variable) for variable in effect.variables):
        return False
    return names(effect.atom, {**binding, **{v.name: v for v in effect.variables}}, fact, objects)
