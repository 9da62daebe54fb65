"""Refinements of a threat: separation, promotion, demotion; and their number."""

from __future__ import annotations

from tailor.executive.planning.ground.ground_action import by_span
from tailor.executive.planning.ground.ground_formula import negation
from tailor.executive.planning.ground.ground_task import GroundTask
from tailor.executive.planning.ground_plans.partial_plan import OpenCondition, PartialPlan, Threat, new
from tailor.executive.planning.structures.linked_list import without
from tailor.executive.planning.structures.orderings import nodes_after


def is_threat(plan: PartialPlan, threat: Threat) -> bool:
    """Whether the node may still come between the link's producer and its consumer."""
    late, link, node = plan.orderings.late, threat.link, threat.node
    return not (nodes_after(plan.orderings, link.first, link.last) >> node & 1 or late[node] >> link.producer & 1)


def count_refinements(plan: PartialPlan, threat: Threat) -> int:
    """Number of refinements of a threat; 0 if it no longer threatens, so that it is dropped first."""
    late, (link, node, conditions, _) = plan.orderings.late, threat
    if nodes_after(plan.orderings, link.first, link.last) >> node & 1 or late[node] >> link.producer & 1:
        return 0
    promotion = not late[node] >> link.last & 1
    demotion = not late[link.producer] >> node & 1
    return promotion + demotion + (len(by_span(conditions)) if conditions else 0)


def refine_threat(task: GroundTask, plan: PartialPlan, threat: Threat) -> list[PartialPlan]:
    """All resolvers of the threat; the plan without it if it no longer threatens."""
    steps, orderings, effects, links, opened, threats, open_count, threat_count, cost = plan
    threats, threat_count = without(threats, threat), threat_count - 1
    rest = new(PartialPlan, (steps, orderings, effects, links, opened, threats, open_count, threat_count, cost))
    if not is_threat(plan, threat):
        return [rest]
    children = separations(task, rest, threat) if threat.conditions else []
    link, node = threat.link, threat.node
    for before, after in ((link.last, node), (node, link.producer)):  # promotion, then demotion
        ordered = orderings.ordered(before, after)
        if ordered is not None:
            resolved = (steps, ordered, effects, links, opened, threats, open_count, threat_count, cost)
            children.append(new(PartialPlan, resolved))
    return children


def separations(task: GroundTask, plan: PartialPlan, threat: Threat) -> list[PartialPlan]:
    """Plans in which the condition of the threatening (conditional) effect is made false."""
    start = task.node_of(task.step_of(threat.node))
    children = []
    for (begin, end), condition in by_span(threat.conditions).items():
        cell = OpenCondition(negation(condition), start + begin, start + end, plan.open)
        children.append(plan._replace(open=cell, open_count=plan.open_count + 1))
    return children
