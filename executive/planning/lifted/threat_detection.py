"""Detection of threats by effects of a lifted plan to causal links."""

from __future__ import annotations

from collections.abc import Iterable

from tailor.executive.planning.lifted.lifted_plan import LiftedLink, LiftedPlan, LiftedThreat, opposing
from tailor.executive.planning.lifted.task import LiftedTask, PlacedEffect
from tailor.executive.planning.structures.orderings import nodes_after


def threatened_by_step(
    task: LiftedTask, plan: LiftedPlan, effects: tuple[PlacedEffect, ...], links: LiftedLink | None
) -> LiftedPlan:
    """The plan with the threats of a new step's effects to older links, newest link first."""
    while links is not None:
        if links.literal.predicate not in task.world.static:
            plan = threatened(task, plan, effects, links)
        links = links.rest
    return plan


def threatened(task: LiftedTask, plan: LiftedPlan, effects: Iterable[PlacedEffect], link: LiftedLink) -> LiftedPlan:
    """The plan with the threats of some effects to one link."""
    cell, count = plan.threats, plan.threat_count
    for placed in effects:
        if opposing(link.literal, placed.literal, plan.bindings):
            threat = LiftedThreat(link, placed.node, placed.literal, placed.effect.guards, cell)
            if is_threat(task, plan, threat):
                cell, count = threat, count + 1
    return plan._replace(threats=cell, threat_count=count)


def is_threat(task: LiftedTask, plan: LiftedPlan, threat: LiftedThreat) -> bool:
    """Whether the effect may still undo the link, by orderings and bindings, and its own step does not restore it."""
    late, link, node = plan.orderings.late, threat.link, threat.node
    if node in (link.producer, link.last):
        return False  # the consumer may undo its own condition, except a condition over all at its start
    if nodes_after(plan.orderings, link.first, link.last) >> node & 1 or late[node] >> link.producer & 1:
        return False
    if not opposing(link.literal, threat.effect, plan.bindings):
        return False
    step = task.ground.step_of(node)
    return (
        threat.effect.positive
        or step == 0
        or not any(
            placed.node == node
            and placed.literal.positive
            and not placed.effect.guards
            and placed.literal.predicate == link.literal.predicate
            and not plan.bindings.differing(zip(placed.literal.terms, link.literal.terms, strict=True))
            for placed in task.effects_of(plan.steps[step - 1], step)
        )
    )
