"""Converts a reported plan into a graph: steps, causal links, and orderings without a link."""

from __future__ import annotations

from tailor.executive import planning
from tailor.schemas.messages import PlanReport
from tailor.schemas.reason_text import reason_text
from tailor.tools.viewer.event_fields import Fields


def plan_graph(message: PlanReport) -> Fields:
    """Fields of the page for a plan; without steps if there is no plan or its text is invalid."""
    fields: Fields = {
        "status": message.status,
        "way": message.way,
        "reason": reason_text(message.reason, message.detail),
        "generated": message.generated,
        "visited": message.visited,
        "text": message.plan,
    }
    if not message.plan:
        return fields
    try:
        plan = planning.parse_plan(message.plan)
    except planning.PlanTextError as error:
        return fields | {"reason": str(error)}
    return fields | _graph(plan) | {"whole": planning.number_of_steps(message.plan)}


def _graph(plan: planning.Plan) -> Fields:
    links = [{"from": link.producer, "literal": str(link.literal), "to": _node(link.consumer)} for link in plan.links]
    linked = {(link["from"], link["to"]) for link in links}
    orderings = [[before, after] for before, after in _reduced(plan.orderings) if (before, after) not in linked]
    return {
        "initial": [" ".join(fact) for fact in plan.initial],
        "steps": [{"id": step.id, "words": list(step.action)} for step in plan.steps],
        "links": links,
        "orderings": orderings,
    }


def _node(consumer: int) -> int | str:
    return "goal" if consumer == planning.GOAL else consumer


def _reduced(orderings: tuple[tuple[int, int], ...]) -> list[tuple[int, int]]:
    """Transitive reduction of closed orderings: i < j without a k between them."""
    after: dict[int, set[int]] = {}
    for i, j in orderings:
        after.setdefault(i, set()).add(j)
    return sorted(
        (i, j) for i, later in after.items() for j in later - set().union(*(after.get(k, set()) for k in later))
    )
