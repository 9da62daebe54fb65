"""Refining an open condition: a new step, an old step, or the initial state achieves it.

Owns the order of the children, which every count depends on.
"""

from __future__ import annotations

from collections.abc import Iterator

from executive.planning.cells import without
from executive.planning.ground_action import GroundAction, GroundEffect
from executive.planning.ground_formula import Every, GroundCondition, Some
from executive.planning.ground_task import GroundTask
from executive.planning.orderings import INITIAL, Orderings
from executive.planning.partial_plan import Link, OpenCondition, PartialPlan, new, step_of
from executive.planning.threat_detection import Guarded, Spanned, guarded_links, threats_by, threats_to


def refine_open(task: GroundTask, plan: PartialPlan, flaw: OpenCondition) -> list[PartialPlan]:
    """All plans that mend the flaw: by a new step of each achiever, by old ones, newest first, by the initial state."""
    condition = flaw.condition
    rest = _without(plan, flaw)
    if isinstance(condition, Some):
        return [_opened(rest, part, flaw) for part in condition.parts]
    if isinstance(condition, Every):
        return [_opened(rest, condition, flaw)]
    children = []
    achievers = task.achievers[condition]
    if achievers:
        undoing = plan.effects.masks()[condition ^ 1]
        guarded = guarded_links(plan.links)
        for action, effect in achievers:
            child = _by_new_step(task, rest, flaw, undoing, guarded, action, effect)
            if child is not None:
                children.append(child)
    for node in _nodes(reusable(plan, flaw)):
        children += _by_old_step(task, rest, flaw, condition, node)
    if condition in task.initial:
        children.append(_linked(task, rest, flaw, condition, INITIAL, plan.orderings))
    return children


def _without(plan: PartialPlan, flaw: OpenCondition) -> PartialPlan:
    """The plan without an open condition; spelled out because `_replace` takes six times as long."""
    steps, orderings, effects, links, opened, threats, open_count, threat_count, cost = plan
    opened = without(opened, flaw)
    return new(PartialPlan, (steps, orderings, effects, links, opened, threats, open_count - 1, threat_count, cost))


def reusable(plan: PartialPlan, flaw: OpenCondition) -> int:
    """The mask of the nodes that make the (literal) condition true and may come before its consumer.

    A condition over all of an action may be met by the action's own start.
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
    """The plan with one part of a compound condition as its newest open conditions."""
    parts = condition.parts if isinstance(condition, Every) else (condition,)
    return _with_conditions(plan, tuple((part, (flaw.first, flaw.last)) for part in parts), 0)


def _with_conditions(plan: PartialPlan, conditions: Spanned, node: int) -> PartialPlan:
    """The plan with more open conditions of one step."""
    opened = _opened_by(conditions, node, plan.open)
    return plan._replace(open=opened, open_count=plan.open_count + len(conditions))


# --- the three ways ------------------------------------------------------------------------------
def _by_new_step(
    task: GroundTask,
    plan: PartialPlan,
    flaw: OpenCondition,
    undoing: int,
    guarded: Guarded,
    action: GroundAction,
    effect: GroundEffect,
) -> PartialPlan | None:
    """The plan with one more step; `undoing` are the nodes that make the condition false, `guarded` its old links."""
    _, first, last, _ = flaw
    literal = effect.literal
    node = len(plan.orderings.late)
    orderings = plan.orderings.with_step(action, effect.moment, first)
    if orderings is None:
        return None
    steps = (*plan.steps, action)
    link = new(Link, (node + effect.moment, literal, first, last, plan.links))
    undoing |= action.bits.get(literal ^ 1, 0) << node
    threats, count = threats_to(task, steps, orderings, undoing, link, plan.threats, plan.threat_count)
    threats, count = threats_by(action, node, orderings.late, guarded, threats, count)
    conditions = action.conditions + effect.conditions if effect.conditions else action.conditions
    return new(
        PartialPlan,
        (
            steps,
            orderings,
            plan.effects.with_step(action, node),
            link,
            _opened_by(conditions, node, plan.open),
            threats,
            plan.open_count + len(conditions),
            count,
            plan.cost + task.costs[action.number],
        ),
    )


def _opened_by(conditions: Spanned, node: int, cell: OpenCondition | None) -> OpenCondition | None:
    """Opens a step's conditions so that the first stands at the head; `node` is the step's start."""
    for condition, (first, last) in reversed(conditions):
        cell = new(OpenCondition, (condition, node + first, node + last, cell))
    return cell


def _by_old_step(
    task: GroundTask, plan: PartialPlan, flaw: OpenCondition, literal: int, node: int
) -> list[PartialPlan]:
    orderings = plan.orderings if node == flaw.first else plan.orderings.ordered(node, flaw.first)
    if orderings is None:
        return []
    step = step_of(task, node)
    if step == 0 or plan.steps[step - 1].simple:
        return [_linked(task, plan, flaw, literal, node, orderings)]
    start = task.first_node + (step - 1) * task.moments
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
