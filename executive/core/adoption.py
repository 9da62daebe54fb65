"""What becomes of a deliberation's result.

A decision is adopted at once between actions, while one runs only if it is worth a change of course. A failure ends the
task once it has been doubted for a while: a percept that is wrong once ends none.
"""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.course import halted, halted_if_lost, redirected, starts_another
from tailor.executive.core.execution import Running
from tailor.executive.core.perception import slow_inputs
from tailor.executive.core.state import State, Task
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Decision
from tailor.executive.interfaces.reasons import Cause, Reason, Result
from tailor.executive.refinement.rolling_start import begins_too_fast

DOUBT_NS = 500_000_000  # for which there has to be no way: two pictures or more of a slow camera, and five ticks
OF_THE_BELIEF = {Reason.UNSOLVABLE, Reason.NOT_INSTANTIABLE, Reason.NO_SUBGOAL, Reason.NO_VALID_CHOICE}


def adopted(context: Context, state: State, decision: Decision, decided: bool) -> State:
    """The state with a decision: at once between actions, otherwise only if it is worth a change.

    A robot that is too fast for a decision which begins with an asserted subgoal brakes instead, and decides at rest.
    """
    task = state.task
    new_plan = task.plan is not decision.plan
    if task.running is None:
        return replace(state, task=_with_decision(task, decision, new_plan))
    running = _as_step_of(decision, task.running, task.plan)
    if starts_another(decision, running) and slow_inputs(context, state) is not None:
        return halted_if_lost(context, state)
    if task.decision is not None and decision.number == task.decision.number:
        return _redirected_if_better(context, state, running, task.decision, decision)
    if not decided:
        return state
    if decision.sequence.actions[0].asserted and begins_too_fast(decision.sequence):
        return halted(context, state)
    return replace(state, task=redirected(context, _with_decision(task, decision, new_plan), running, state.now_ns))


def _with_decision(task: Task, decision: Decision, new_plan: bool) -> Task:
    done = frozenset() if new_plan else task.done
    return replace(task, decision=decision, plan=decision.plan, done=done, doubted_until_ns=0)


def failed(context: Context, state: State, cause: Cause | None) -> State:
    """Without a decision a running action continues while its plan holds; without an action the task has failed.

    It fails at once for causes that no other belief changes, such as a limit of the search.
    """
    task = state.task
    if task.running is not None:
        return halted_if_lost(context, state)
    if cause is not None and cause.reason in OF_THE_BELIEF:
        until_ns = task.doubted_until_ns or state.now_ns + DOUBT_NS
        if state.now_ns < until_ns:
            return replace(state, task=replace(task, doubted_until_ns=until_ns))
    return replace(state, task=replace(task, active=False, result=Result.FAILED, result_cause=cause, decision=None))


def _redirected_if_better(context: Context, state: State, running: Running, old: Decision, new: Decision) -> State:
    """A better subgoal for the running action, if it comes early and its predicted gain exceeds the threshold."""
    settings = context.settings
    early = running.elapsed_s(state.now_ns) <= settings.refine_while_running_s
    gain_s = old.choice.total_s - new.choice.total_s
    if not early or gain_s <= 0 or gain_s < settings.adopt_gain_s:
        return state
    task = replace(state.task, decision=new)
    return replace(state, task=redirected(context, task, running, state.now_ns))


def _as_step_of(decision: Decision, running: Running, plan: planning.Plan | None) -> Running:
    """The running action as the first step of a decision, whose plan may have another number for it."""
    first = decision.sequence.actions[0]
    if plan is None or _undertaking(plan, running.step, running) != _undertaking(decision.plan, first.step, running):
        return running
    return replace(running, step=first.step)


def _undertaking(plan: planning.Plan, step: int, running: Running) -> planning.Fact | None:
    """The ground action of a step without the label of its start: a robot on its way is no longer there."""
    action = plan.action_of(step)
    arguments = {parameter.argument for parameter in running.action.parameters}
    if action is None or len(arguments) <= 1:
        return action
    start = 1 + min(arguments)
    return (*action[:start], *action[start + 1 :])
