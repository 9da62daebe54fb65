"""Which messages a tick publishes: status always; plan, subgoals and their search on change."""

from __future__ import annotations

from dataclasses import dataclass

from tailor.executive import planning
from tailor.executive.core.action_cycle import finished_message
from tailor.executive.core.deliberation_cycle import pending_request
from tailor.executive.core.effects import missing_effects, planned_action
from tailor.executive.core.execution import Running
from tailor.executive.core.state import Output, State
from tailor.executive.core.tick_messages import (
    contexts_message,
    plan_message,
    refinement_message,
    status_message,
    subgoals_message,
)
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Decision, Deliberation
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.schemas import messages as m


@dataclass(frozen=True, slots=True)
class Published:
    """State of publication before this tick's deliberation."""

    deliberation: Deliberation | None
    request: m.PlanRequest | None
    plan_results: int  # of that deliberation
    plan: planning.Plan | None
    running: Running | None
    finished: int
    decision: Decision | None
    searched: tuple[int, float]


def snapshot(state: State) -> Published:
    """State of publication of a state; taken before its deliberation is advanced."""
    deliberation = state.deliberation
    return Published(
        deliberation,
        pending_request(state),
        len(deliberation.plan_results) if deliberation is not None else 0,
        state.task.plan,
        state.task.running,
        state.task.finished,
        state.task.decision,
        _searched(deliberation),
    )


def reports(context: Context, state: State, published: Published) -> tuple[Output, ...]:
    """The messages about this tick, the status last."""
    outputs: list[Output] = []
    if published.running is not None and state.task.finished > published.finished:
        end = _overtaken(context, state, published.plan, published.running)
        outputs.append(Output("finished", finished_message(context, state, published.finished, published.running, end)))
    deliberation = state.deliberation
    if deliberation is not None:
        fresh = deliberation is not published.deliberation
        results = deliberation.plan_results[0 if fresh else published.plan_results :]
        outputs.extend(Output("plan", plan_message(context, state, result)) for result in results)
        if deliberation.source.request not in (None, published.request):
            outputs.append(Output("plan_request", deliberation.source.request))
        changed = fresh or _searched(deliberation) != published.searched
        if changed and (message := refinement_message(context, state, deliberation)) is not None:
            outputs.append(Output("refinement", message))
    if state.task.decision is not None and state.task.decision is not published.decision:
        if any(action.context for action in state.task.decision.sequence.actions):
            outputs.append(Output("contexts", contexts_message(context, state, state.task.decision)))
        outputs.append(Output("subgoals", subgoals_message(context, state, state.task.decision)))
    return (*outputs, Output("status", status_message(context, state)))


def _overtaken(context: Context, state: State, plan: planning.Plan | None, running: Running) -> tuple[str, Cause]:
    """Outcome of an action that the new decision does not begin with: its effects hold, or others come first."""
    action = planned_action(plan, running)
    if action is not None and not missing_effects(context, state.task.facts, action):
        return "done", Cause(Reason.EFFECTS_HOLD)
    return "aborted", state.halting.cause if state.halting is not None else running.lost or Cause(Reason.SUPERSEDED)


def _searched(deliberation: Deliberation | None) -> tuple[int, float]:
    """Progress of the search for subgoals: evaluations, and the optimality gap in percent, -1 if it is unknown."""
    if deliberation is None or deliberation.refinement is None:
        return 0, -1.0
    gap_pct = deliberation.refinement.gap_pct
    return deliberation.refinement.evaluations, -1.0 if gap_pct is None else gap_pct
