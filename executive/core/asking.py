"""The external planner as the core sees it: asked or not, and an answer that comes in with the inputs or too late."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.context import Context
from tailor.executive.core.deliberation import Deliberation
from tailor.executive.core.plan_finding import PlanFinding, request_for
from tailor.executive.core.state import Inputs, State
from tailor.schemas.messages import PlanAnswer, PlanRequest

GRACE_S = 2.0  # beyond the planner's own limit; then whoever was to ask it is not there


def awaited(state: State) -> PlanRequest | None:
    """The request that is still to be answered; a child that works on any other may be killed."""
    return state.deliberation.request if state.deliberation is not None else None


def hear_planner(context: Context, state: State, inputs: Inputs) -> None:
    """Hand this tick's answer to the deliberation that waits for it, or tell it that none will come."""
    request, deliberation = awaited(state), state.deliberation
    if request is None or deliberation is None:
        return
    for sample in inputs.samples:
        if isinstance(sample.message, PlanAnswer):
            deliberation.take(sample.message)
    limit_s = context.settings.external.limit_s + GRACE_S
    if context.stamp(state.now_ns) - request.stamp_ns > limit_s * 1e9:
        late = f"no answer within {limit_s:g} s"
        deliberation.take(PlanAnswer(context.stamp(state.now_ns), request.id, "timeout", "", late))


def finding_for(context: Context, state: State, problem: planning.Problem, number: int) -> PlanFinding:
    """The way to a plan: the external planner first, where there is one and it has not failed for this goal."""
    ask = bool(context.settings.external.command) and not state.task.external_failed
    request = request_for(context, problem, number, state.now_ns) if ask else None
    return PlanFinding(context, problem, state.ground, request)


def noting_failure(state: State, deliberation: Deliberation) -> State:
    """An external planner that failed is not asked again until there is a new goal."""
    if state.task.external_failed or not any(found.status == "failed" for found in deliberation.told):
        return state
    return replace(state, task=replace(state.task, external_failed=True))
