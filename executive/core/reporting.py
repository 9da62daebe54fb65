"""Messages about a tick's deliberation: status always; plan, subgoals and their search on change."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tailor.executive import planning
from tailor.executive.core.action_cycle import finished_message
from tailor.executive.core.execution import Running
from tailor.executive.core.state import Output, State
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Decision, Deliberation
from tailor.executive.deliberation.plan_source import PlanFound
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable
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
        deliberation.source.request if deliberation is not None else None,
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
        outputs.extend(Output("plan", _plan(context, state, result)) for result in results)
        if deliberation.source.request not in (None, published.request):
            outputs.append(Output("plan_request", deliberation.source.request))
        if _searched(deliberation) != published.searched or fresh:
            outputs.extend(_refinement(context, state, deliberation))
    if state.task.decision is not None and state.task.decision is not published.decision:
        if any(action.context for action in state.task.decision.sequence.actions):
            outputs.append(Output("contexts", _contexts(context, state, state.task.decision)))
        outputs.append(Output("subgoals", _subgoals(context, state, state.task.decision)))
    return (*outputs, Output("status", _status(context, state)))


def _overtaken(context: Context, state: State, plan: planning.Plan | None, running: Running) -> tuple[str, Cause]:
    """Outcome of an action that the new decision does not begin with: its effects hold, or others come first."""
    action = plan.action_of(running.step) if plan is not None and not running.asserted else None
    facts = state.task.facts
    if action is not None and planning.apply_action(context.pddl_domain, context.problem, facts, action) <= facts:
        return "done", Cause(Reason.EFFECTS_HOLD)
    return "aborted", Cause(Reason.COURSE_AT_RISK if state.now_ns < state.halted_until_ns else Reason.SUPERSEDED)


def _searched(deliberation: Deliberation | None) -> tuple[int, float]:
    """Progress of the search for subgoals: evaluations, and the optimality gap in percent, -1 if it is unknown."""
    if deliberation is None or deliberation.refinement is None:
        return 0, -1.0
    gap_pct = deliberation.refinement.gap_pct
    return deliberation.refinement.evaluations, -1.0 if gap_pct is None else gap_pct


def _plan(context: Context, state: State, result: PlanFound) -> m.PlanReport:
    reason, detail = _texts(result.refusal)
    return m.PlanReport(
        stamp_ns=context.stamp(state.now_ns),
        status=result.status,
        way=result.way,
        plan=planning.format_excerpt(result.plan) if result.plan is not None else "",
        generated=result.generated,
        visited=result.visited,
        reason=reason,
        detail=detail,
    )


def _finite(value_s: float) -> float:
    """A predicted cost for a message, which takes no infinities: INVALID (Algorithm 4) becomes -1."""
    return value_s if math.isfinite(value_s) else -1.0


def _refinement(context: Context, state: State, deliberation: Deliberation) -> tuple[Output, ...]:
    if deliberation.refinement is None:
        return ()
    report = deliberation.refinement.report()
    settings = context.settings.refinement
    message = m.RefinementReport(
        stamp_ns=context.stamp(state.now_ns),
        tick=state.tick,
        horizon=settings.horizon,
        solver=report.solver or settings.solver,
        finished=deliberation.refinement.finished,
        evaluations=report.evaluations,
        checks=report.checks,
        greedy_s=_finite(report.greedy_s),
        best_s=_finite(report.best_s),
        trace_evaluations=tuple(evaluations for evaluations, _ in report.trace),
        trace_best_s=tuple(best_s for _, best_s in report.trace),
        gap_pct=-1.0 if report.gap_pct is None else report.gap_pct,
    )
    return (Output("refinement", message),)


def _subgoals(context: Context, state: State, decision: Decision) -> m.Subgoals:
    return m.Subgoals(
        stamp_ns=context.stamp(state.now_ns),
        tick=state.tick,
        horizon=context.settings.refinement.horizon,
        actions=tuple(_action(decision, i, action) for i, action in enumerate(decision.sequence.actions)),
    )


def _contexts(context: Context, state: State, decision: Decision) -> m.Contexts:
    objects = {
        action.action.name: m.ActionObjects(
            action=action.action.name,
            columns=action.action.context.names if action.action.context is not None else (),
            values=tuple(value for row in action.context for value in row),
        )
        for action in decision.sequence.actions
        if action.context
    }
    return m.Contexts(context.stamp(state.now_ns), state.tick, tuple(objects.values()))


def _action(decision: Decision, index: int, action: InstantiatedAction) -> m.InstantiatedAction:
    choice = decision.choice
    predicted = index < len(choice.predicted_s)
    names = (parameter.name for parameter in action.action.parameters)
    variables = (decision.sequence.variables[i] for i in action.variables)
    return m.InstantiatedAction(
        action=action.action.name,
        step=action.step,
        asserted=action.asserted,
        predicted_s=choice.predicted_s[index] if predicted else 0.0,
        spread_s=choice.std_s[index] if predicted else 0.0,
        parameters=tuple(_parameter(n, v, decision) for n, v in zip(names, variables, strict=True)),
    )


def _parameter(name: str, variable: Variable, decision: Decision) -> m.Parameter:
    chosen = decision.choice.values.get(variable.id, variable.lower)
    return m.Parameter(
        name=name,
        id=variable.id,
        label=variable.label,
        unit=variable.unit,
        bound=variable.value is not None,
        lower=variable.lower,
        upper=variable.upper,
        value=variable.value if variable.value is not None else chosen,
    )


def _status(context: Context, state: State) -> m.ExecStatus:
    task, running = state.task, state.task.running
    reason, detail = _texts(state.cause)
    result_reason, result_detail = _texts(task.result_cause)
    return m.ExecStatus(
        stamp_ns=context.stamp(state.now_ns),
        tick=state.tick,
        mode=str(state.mode),
        reason=reason,
        scenario=context.scenario.name,
        goal=task.goal,
        result=str(task.result),
        action=running.action.name if running else "",
        action_index=task.finished,
        action_elapsed_s=running.elapsed_s(state.now_ns) if running else 0.0,
        action_predicted_s=running.predicted_s if running else 0.0,
        belief=context.domain.belief_values(state.belief),
        sender=context.sender,
        detail=detail,
        result_reason=result_reason,
        result_detail=result_detail,
    )


def _texts(cause: Cause | None) -> tuple[str, str]:
    return (str(cause.reason), cause.detail) if cause is not None else ("", "")
