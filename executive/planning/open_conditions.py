"""Refining an open condition: a new step, an old step, or the initial state achieves it.

Owns the order of the children, which every count depends on, and the threats that a new link or step brings.
"""

from __future__ import annotations

from collections.abc import Iterator

from executive.planning.cells import without
from executive.planning.ground_action import GroundAction, GroundEffect, Span
from executive.planning.ground_formula import Every, GroundCondition, Some
from executive.planning.ground_task import GroundTask
from executive.planning.orderings import INITIAL, Orderings
from executive.planning.partial_plan import (
    Link,
    OpenCondition,
    PartialPlan,
    Threat,
    new,
    step_of,
)

Spanned = tuple[tuple[GroundCondition, Span], ...]


def refine_open(task: GroundTask, plan: PartialPlan, flaw: OpenCondition) -> list[PartialPlan]:
    """All plans that mend the flaw: by a new step of each achiever, by old ones, newest first, by the initial state."""
    condition = flaw.condition
    rest = plan._replace(open=without(plan.open, flaw), open_count=plan.open_count - 1)
    if isinstance(condition, Some):
        return [_opened(rest, part, flaw) for part in condition.parts]
    if isinstance(condition, Every):
        return [_opened(rest, condition, flaw)]
    children = []
    undoing = plan.effects.masks()[condition ^ 1]
    for action, effect in task.achievers[condition]:
        child = _by_new_step(task, rest, flaw, undoing, action, effect)
        if child is not None:
            children.append(child)
    for node in _nodes(reusable(plan, flaw)):
        children += _by_old_step(task, rest, flaw, condition, node)
    if condition in task.initial:
        children.append(_linked(task, rest, flaw, condition, INITIAL, plan.orderings))
    return children


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
    action: GroundAction,
    effect: GroundEffect,
) -> PartialPlan | None:
    """The plan with one more step; `undoing` are the nodes that make the condition false."""
    _, first, last, _ = flaw
    literal = effect.literal
    node = len(plan.orderings.late)
    orderings = plan.orderings.with_step(action, effect.moment, first)
    if orderings is None:
        return None
    steps = (*plan.steps, action)
    link = new(Link, (node + effect.moment, literal, first, last, plan.links))
    undoing |= action.bits.get(literal ^ 1, 0) << node
    threats, count = _threats_to(task, steps, orderings, undoing, link, plan.threats, plan.threat_count)
    threats, count = _threats_by(action, node, orderings.late, plan.links, threats, count)
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
    threats, count = _threats_to(task, plan.steps, orderings, undoing, link, plan.threats, plan.threat_count)
    return new(
        PartialPlan,
        (plan.steps, orderings, plan.effects, link, plan.open, threats, plan.open_count, count, plan.cost),
    )


# --- threats -------------------------------------------------------------------------------------
Threats = tuple[Threat | None, int]  # the list and its length
_ALWAYS: tuple[Spanned, ...] = ((),)  # one effect without conditions


def _threats_to(
    task: GroundTask,
    steps: tuple[GroundAction, ...],
    orderings: Orderings,
    undoing: int,
    link: Link,
    threats: Threat | None,
    count: int,
) -> Threats:
    """Adds the threats to a new link by the nodes that undo it: newest first, so that the oldest ends at the head."""
    producer, literal, first, last, _ = link
    late = orderings.late
    mask = undoing & ~late[last] & ~(1 << producer)
    if first == last:
        mask &= ~(1 << first)  # the consumer may undo its condition; not at its start what it needs over all
    while mask:
        node = mask.bit_length() - 1
        mask ^= 1 << node
        if not late[node] >> producer & 1:
            for conditions in _ALWAYS if task.simple else _deletions_at(task, steps, node, literal ^ 1):
                threats = Threat(link, node, conditions, threats)
                count += 1
    return threats, count


def _deletions_at(task: GroundTask, steps: tuple[GroundAction, ...], node: int, literal: int) -> tuple[Spanned, ...]:
    """The conditions under which a node, of a step or of a timed literal, makes a literal true."""
    step = step_of(task, node)
    return _deletions(steps[step - 1], literal, (node - task.first_node) % task.moments) if step else _ALWAYS


def _threats_by(
    action: GroundAction, node: int, late: tuple[int, ...], link: Link | None, threats: Threat | None, count: int
) -> Threats:
    """Adds the threats by a new step to older links, newest link first."""
    bits = action.bits
    while link is not None:
        producer, literal, _, last, rest = link
        if literal ^ 1 in bits:
            mask = bits[literal ^ 1] << node & ~late[last]
            while mask:
                at = mask.bit_length() - 1
                mask ^= 1 << at
                if not late[at] >> producer & 1:
                    for conditions in _deletions(action, literal ^ 1, at - node):
                        threats = Threat(link, at, conditions, threats)
                        count += 1
        link = rest
    return threats, count


def _deletions(action: GroundAction, literal: int, moment: int) -> tuple[Spanned, ...]:
    """The conditions under which an action makes a literal true at a moment: one empty set when it always does."""
    if action.simple:
        return _ALWAYS
    found = tuple(e.conditions for e in action.effects if e.literal == literal and e.moment == moment)
    return _ALWAYS if () in found else found
