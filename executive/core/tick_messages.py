"""The messages of a tick, made from the executive's state."""

from __future__ import annotations

import math

from tailor.executive import planning
from tailor.executive.core.state import State
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Decision, Deliberation
from tailor.executive.deliberation.plan_found import PlanFound
from tailor.executive.interfaces.domain_results import telemetry
from tailor.executive.interfaces.reasons import Cause
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable
from tailor.schemas import messages as m


def plan_message(context: Context, state: State, result: PlanFound) -> m.PlanReport:
    """A result of planning."""
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


def refinement_message(context: Context, state: State, deliberation: Deliberation) -> m.RefinementReport | None:
    """Progress of the search for subgoals; None before it has begun."""
    if deliberation.refinement is None:
        return None
    report = deliberation.refinement.report()
    settings = context.settings.refinement
    return m.RefinementReport(
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


def subgoals_message(context: Context, state: State, decision: Decision) -> m.Subgoals:
    """The actions of a decision with their chosen parameters."""
    return m.Subgoals(
        stamp_ns=context.stamp(state.now_ns),
        tick=state.tick,
        horizon=context.settings.refinement.horizon,
        actions=tuple(_action(decision, i, action) for i, action in enumerate(decision.sequence.actions)),
    )


def contexts_message(context: Context, state: State, decision: Decision) -> m.Contexts:
    """The objects that a decision's actions were judged with, once for each action."""
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


def status_message(context: Context, state: State) -> m.ExecStatus:
    """What the executive does, and why."""
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
        belief=telemetry(context.domain, state.belief),
        sender=context.sender,
        detail=detail,
        result_reason=result_reason,
        result_detail=result_detail,
    )


def _texts(cause: Cause | None) -> tuple[str, str]:
    return (str(cause.reason), cause.bus_detail) if cause is not None else ("", "")
