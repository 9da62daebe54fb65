"""Refinement of an open condition by a new step: one plan per action that achieves it."""

from __future__ import annotations

from typing import NamedTuple

from tailor.executive.planning.ground.ground_action import GroundAction, GroundEffect
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.partial_plan import Link, OpenCondition, PartialPlan, Threat, new
from tailor.executive.planning.ground_plans.threat_detection import (
    LinksByLiteral,
    Spanned,
    guarded_links,
    threats_by,
    threats_to,
)
from tailor.executive.planning.structures.orderings import Orderings

MANY_LINKS = 200  # plans of everyday problems have fewer; looking at so many takes as long as making a plan


class _Insertion(NamedTuple):
    """The changes that do not depend on the action's name; actions of equal duration share them."""

    orderings: Orderings
    link: Link
    threats: Threat | None  # threats to the new link first
    threat_count: int


def new_step_plans(task: GroundTask, plan: PartialPlan, flaw: OpenCondition, literal: int) -> list[PartialPlan]:
    """The plans in which a new step achieves the condition, in the order of the achievers.

    Args:
      task: The ground task.
      plan: The partial plan, the open condition already removed.
      flaw: The open condition.
      literal: Its literal.
    """
    achievers = task.achievers[literal]
    if not achievers:
        return []
    steps, _, effects, links, opened, _, open_count, _, cost = plan
    node = len(plan.orderings.late)
    guarded = guarded_links(links)
    by_literal = LinksByLiteral(guarded) if len(guarded) > MANY_LINKS else None
    insertions: dict[tuple[int, int, int | None, int], _Insertion | None] = {}
    children = []
    for action, effect in achievers:
        undoes_literal = literal ^ 1 in action.bits  # its threats to the new link are then its own
        kind = (effect.moment, action.shortest, action.longest, action.number if undoes_literal else -1)
        if kind not in insertions:
            insertions[kind] = _insertion(task, plan, flaw, action, effect)
        insertion = insertions[kind]
        if insertion is None:
            continue
        orderings, link, threats, count = insertion
        if by_literal is not None:
            guarded = by_literal.undone_by(action)
        threats, count = threats_by(action, node, orderings, guarded, threats, count)
        conditions = action.conditions + effect.conditions if effect.conditions else action.conditions
        children.append(
            new(
                PartialPlan,
                (
                    (*steps, action),
                    orderings,
                    effects.with_step(action, node),
                    link,
                    opened_by(conditions, node, opened),
                    threats,
                    open_count + len(conditions),
                    count,
                    cost + task.costs[action.number],
                ),
            )
        )
    return children


def _insertion(
    task: GroundTask, plan: PartialPlan, flaw: OpenCondition, action: GroundAction, effect: GroundEffect
) -> _Insertion | None:
    """The insertion of an action and those of its kind; None if the orderings become inconsistent."""
    _, first, last, _ = flaw
    literal = effect.literal
    orderings = plan.orderings.with_step(action, effect.moment, first)
    if orderings is None:
        return None
    node = len(plan.orderings.late)
    link = new(Link, (node + effect.moment, literal, first, last, plan.links))
    undoing = plan.effects.masks()[literal ^ 1] | action.bits.get(literal ^ 1, 0) << node
    steps = (*plan.steps, action)
    threats, count = threats_to(task, steps, orderings, undoing, link, plan.threats, plan.threat_count)
    return _Insertion(orderings, link, threats, count)


def opened_by(conditions: Spanned, node: int, cell: OpenCondition | None) -> OpenCondition | None:
    """The list with a step's conditions in front, the first at the head; `node` is the step's start."""
    for condition, (first, last) in reversed(conditions):
        cell = new(OpenCondition, (condition, node + first, node + last, cell))
    return cell
