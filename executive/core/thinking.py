"""The second part of a tick: whatever is left of the budget advances the deliberation."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive.core.action_cycle import running_from
from tailor.executive.core.asking import finding_for, noting_failure
from tailor.executive.core.context import Context
from tailor.executive.core.deliberation import Decision, Deliberation
from tailor.executive.core.execution import Running
from tailor.executive.core.modes import Mode
from tailor.executive.core.plan_finding import problem_of_now
from tailor.executive.core.reusing import look_further, reusable
from tailor.executive.core.state import State, Task
from tailor.executive.interfaces.budget import Budget


def think(context: Context, state: State, budget: Budget) -> State:
    """Start, go on with, or take up the result of the deliberation."""
    if state.mode is not Mode.EXECUTING:
        return state
    state = _with_deliberation(context, state)
    deliberation = state.deliberation
    if deliberation is None:
        return state
    deliberation.advance(budget)
    state = noting_failure(state, deliberation)
    if deliberation.stage == "failed":
        return _gave_up(context, state, deliberation.reason)
    if deliberation.nothing_to_do():
        ended = state.task.finished + (state.task.running is not None)
        task = replace(state.task, active=False, result="achieved", running=None, decision=None, finished=ended)
        return replace(state, task=task)
    decision = deliberation.decision()
    if decision is not None:
        state = _adopted(context, state, decision, deliberation.stage == "decided")
    if deliberation.stage == "decided":
        state = look_further(context, state, budget)
        deliberation.certify(budget)  # what is left of the budget
    return state


def _with_deliberation(context: Context, state: State) -> State:
    task = state.task
    ongoing = state.deliberation is not None and state.deliberation.stage not in ("decided", "failed")
    idle = task.running is None and task.decision is None
    if ongoing or not (idle or _bindings_violated(state)):
        return state
    facts = context.domain.anchor(state.belief, context.scenario, task.facts)
    number = state.deliberations + 1
    problem = problem_of_now(context, facts, task.goal)
    source = reusable(context, problem, task, state.improvement) or finding_for(context, state, problem, number)
    deliberation = Deliberation(context, state.belief, number, source)
    return replace(state, deliberation=deliberation, deliberations=number, task=replace(task, facts=facts))


def _gave_up(context: Context, state: State, reason: str) -> State:
    """No decision from here: a running action goes on with what it has, else the task has failed."""
    if state.task.running is not None:
        return state
    return replace(state, task=replace(state.task, active=False, result=f"failed: {reason}", decision=None))


def _adopted(context: Context, state: State, decision: Decision, decided: bool) -> State:
    """Take a decision up: at once between actions, and while one runs only if it is worth it."""
    task = state.task
    fresh = task.plan is not decision.plan
    if task.running is None:
        return replace(state, task=_with_decision(task, decision, fresh))
    if task.decision is not None and decision.number == task.decision.number:
        return _improved(context, state, task.running, task.decision, decision)
    if not decided:
        return state
    return replace(state, task=_redirected(_with_decision(task, decision, fresh), task.running, state.now_ns))


def _with_decision(task: Task, decision: Decision, fresh: bool) -> Task:
    return replace(task, decision=decision, plan=decision.plan, done=frozenset() if fresh else task.done)


def _improved(context: Context, state: State, running: Running, old: Decision, new: Decision) -> State:
    """A better subgoal for the running action, if it comes early and its predicted gain clears the threshold."""
    settings = context.settings
    early = running.elapsed_s(state.now_ns) <= settings.refine_while_running_s
    if not early or old.choice.total_s - new.choice.total_s < settings.adopt_gain_s:
        return state
    task = replace(state.task, decision=new)
    return replace(state, task=_redirected(task, running, state.now_ns))


def _redirected(task: Task, running: Running, now_ns: int) -> Task:
    """The running action with the values of the task's decision, or the decision's own first action."""
    assert task.decision is not None
    following = running_from(task.decision, now_ns)
    if following.action.name != running.action.name or following.step != running.step:
        return replace(task, running=following, finished=task.finished + 1)
    predicted_s = running.elapsed_s(now_ns) + following.predicted_s
    return replace(task, running=replace(following, started_ns=running.started_ns, predicted_s=predicted_s))


def _bindings_violated(state: State) -> bool:
    """Whether a believed value that the running sequence is bound to has moved beyond its tolerance."""
    decision = state.task.decision
    if decision is None or state.task.running is None:
        return False
    return decision.watch.bindings_violated(state.belief)
