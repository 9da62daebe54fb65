"""Refinements of a lifted threat: separation by bindings or by a failing guard, promotion, demotion."""

from __future__ import annotations

from collections.abc import Iterator

from tailor.executive.planning.lifted.formula import of_step
from tailor.executive.planning.lifted.lifted_plan import LiftedPlan, LiftedThreat, opened
from tailor.executive.planning.lifted.task import LiftedTask
from tailor.executive.planning.lifted.threat_detection import is_threat
from tailor.executive.planning.structures.linked_list import without


def refine_threat(task: LiftedTask, plan: LiftedPlan, threat: LiftedThreat) -> list[LiftedPlan]:
    """All resolvers of the threat; the plan without it if it no longer threatens."""
    rest = plan._replace(threats=without(plan.threats, threat), threat_count=plan.threat_count - 1)
    if not is_threat(task, plan, threat):
        return [rest]
    children = list(separations(task, rest, threat))
    for before, after in ((threat.link.last, threat.node), (threat.node, threat.link.producer)):
        orderings = plan.orderings.ordered(before, after)
        if orderings is not None:
            children.append(rest._replace(orderings=orderings))
    return children


def separations(task: LiftedTask, plan: LiftedPlan, threat: LiftedThreat) -> Iterator[LiftedPlan]:
    """The plans in which the effect does not undo the link: a pair of terms differs, or a guard of the effect fails."""
    for a, b in plan.bindings.differing(zip(threat.effect.terms, threat.link.literal.terms, strict=True)):
        bindings = plan.bindings.separated(a, b)
        if bindings is not None:
            yield plan._replace(bindings=bindings)
    step = task.ground.step_of(threat.node)
    for guard in threat.guards:
        first, last = (task.ground.node_of(step) + moment for moment in guard.span)
        child = opened(plan, of_step(guard.fails, step), first, last)
        if child is not None:
            yield child


def count_refinements(task: LiftedTask, plan: LiftedPlan, threat: LiftedThreat) -> int:
    """Number of refinements of a threat; 1 if it no longer threatens."""
    if not is_threat(task, plan, threat):
        return 1
    late, link, node = plan.orderings.late, threat.link, threat.node
    promotion = not late[node] >> link.last & 1
    demotion = not late[link.producer] >> node & 1
    return promotion + demotion + sum(1 for _ in separations(task, plan, threat))
