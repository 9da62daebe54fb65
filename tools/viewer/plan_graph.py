"""A reported plan as a graph to draw: steps by level, causal links and bare orderings told apart."""

from __future__ import annotations

from tailor.executive import planning
from tailor.schemas.messages import PlanReport
from tailor.tools.viewer.event_fields import Fields


def plan_graph(message: PlanReport) -> Fields:
    """The page's fields of a plan; without steps where there is none, or where its text cannot be read."""
    told: Fields = {
        "status": message.status,
        "way": message.way,
        "reason": message.reason,
        "generated": message.generated,
        "visited": message.visited,
        "text": message.plan,
    }
    if not message.plan:
        return told
    try:
        plan = planning.parse_plan(message.plan)
    except planning.PlanTextError as error:
        return told | {"reason": str(error)}
    return told | _graph(plan)


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
    """The orderings that do not follow from others: i < j with no k between."""
    known = set(orderings)
    between = {(i, j) for i, k in known for k2, j in known if k == k2}
    return sorted(known - between)
