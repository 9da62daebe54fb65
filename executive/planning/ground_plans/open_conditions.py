"""Refinements of an open condition: achieved by a new step, an old step or the initial state.

Owns the order of the children, which every count depends on.
"""

from __future__ import annotations

from collections.abc import Iterator

from tailor.executive.planning.ground.ground_formula import GroundCondition
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.new_steps import new_step_plans, opened_by
from tailor.executive.planning.ground_plans.partial_plan import Link, OpenCondition, PartialPlan, new
from tailor.executive.planning.ground_plans.threat_detection import Spanned, threats_to
from tailor.executive.planning.structures.connectives import Conjunction, Disjunction
from tailor.executive.planning.structures.linked_list import without
from tailor.executive.planning.structures.orderings import INITIAL, Orderings


def refine_open(task: GroundTask, plan: PartialPlan, flaw: OpenCondition) -> list[PartialPlan]:
    """All resolvers of an open condition: new steps, old steps (newest first), the initial state."""
    condition = flaw.condition
    rest = _without(plan, flaw)
    if isinstance(condition, Disjunction):
        return [_opened(rest, part, flaw) for part in condition.parts]
    if isinstance(condition, Conjunction):
        return [_opened(rest, condition, flaw)]
    children = new_step_plans(task, rest, flaw, condition)
    for node in _nodes(reusable(plan, flaw)):
        children += _by_old_step(task, rest, flaw, condition, node)
    if condition in task.initial:
        children.append(_linked(task, rest, flaw, condition, INITIAL, plan.orderings))
    return children


def _without(plan: PartialPlan, flaw: OpenCondition) -> PartialPlan:
    """The plan without an open condition; written out because `_replace` takes six times as long."""
    steps, orderings, effects, links, opened, threats, open_count, threat_count, cost = plan
    opened = without(opened, flaw)
    return new(PartialPlan, (steps, orderings, effects, links, opened, threats, open_count - 1, threat_count, cost))


def reusable(plan: PartialPlan, flaw: OpenCondition) -> int:
    """Bit mask of the nodes that achieve the (literal) condition and may come before its consumer.

    A condition over all of an action may be achieved by the action's own start.
    """
    assert isinstance(flaw.condition, int)
    late = plan.orderings.late[flaw.first]
    if flaw.first != flaw.last:
        late ^= 1 << flaw.first
    return plan.effects.masks()[flaw.condition] & ~late


def _nodes(mask: int) -> Iterator[int]:
    """The nodes of a mask, newest first."""
    while mask:
        node = mask.bit_length() - 1
        mask ^= 1 << node
        yield node


def _opened(plan: PartialPlan, condition: GroundCondition, flaw: OpenCondition) -> PartialPlan:
    """The plan with a part of a compound condition as newest open conditions."""
    parts = condition.parts if isinstance(condition, Conjunction) else (condition,)
    return _with_conditions(plan, tuple((part, (flaw.first, flaw.last)) for part in parts), 0)


def _with_conditions(plan: PartialPlan, conditions: Spanned, node: int) -> PartialPlan:
    """The plan with more open conditions of one step."""
    steps, orderings, effects, links, opened, threats, open_count, threat_count, cost = plan
    opened = opened_by(conditions, node, opened)
    count = open_count + len(conditions)
    return new(PartialPlan, (steps, orderings, effects, links, opened, threats, count, threat_count, cost))


# --- achievers -----------------------------------------------------------------------------------
def _by_old_step(
    task: GroundTask, plan: PartialPlan, flaw: OpenCondition, literal: int, node: int
) -> list[PartialPlan]:
    orderings = plan.orderings if node == flaw.first else plan.orderings.ordered(node, flaw.first)
    if orderings is None:
        return []
    step = task.step_of(node)
    if step == 0 or plan.steps[step - 1].simple:
        return [_linked(task, plan, flaw, literal, node, orderings)]
    start = task.node_of(step)
    return [
        _linked(task, _with_conditions(plan, effect.conditions, start), flaw, literal, node, orderings)
        for effect in plan.steps[step - 1].effects
        if effect.literal == literal and effect.moment == node - start
    ]


def _linked(
    task: GroundTask, plan: PartialPlan, flaw: OpenCondition, literal: int, producer: int, orderings: Orderings
) -> PartialPlan:
    _, first, last, _ = flaw
    link = new(Link, (producer, literal, first, last, plan.links))
    undoing = plan.effects.masks()[literal ^ 1]
    threats, count = threats_to(task, plan.steps, orderings, undoing, link, plan.threats, plan.threat_count)
    return new(
        PartialPlan,
        (plan.steps, orderings, plan.effects, link, plan.open, threats, plan.open_count, count, plan.cost),
    )
