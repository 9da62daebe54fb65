"""Converts a reported plan into a graph: steps, causal links, and orderings without a link."""

from __future__ import annotations

from tailor.executive import planning
from tailor.schemas.messages import PlanReport
from tailor.schemas.reason_text import reason_text
from tailor.tools.viewer.bare_orderings import bare_orderings
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
    return {
        "initial": [" ".join(fact) for fact in plan.initial],
        "steps": [{"id": step.id, "words": list(step.action)} for step in plan.steps],
        "links": links,
        "orderings": [list(ordering) for ordering in bare_orderings(plan)],
    }


def _node(consumer: int) -> int | str:
    return "goal" if consumer == planning.GOAL else consumer
