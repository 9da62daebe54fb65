"""The life of an action: start, control, finish, abort. Runs first in each tick and takes well under a millisecond."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.command_guard import at_rest, checked
from tailor.executive.core.context import Context
from tailor.executive.core.execution import Running, control_step, first_action
from tailor.executive.core.modes import Mode
from tailor.executive.core.state import State, Task
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.values import Fact
from tailor.schemas.messages import ActionFinished


def act(context: Context, state: State) -> tuple[State, ActionFinished | None]:
    """Advance the running action, or start the first action of the decision, and set the command.

    Returns:
      The state after it, and the report of an action that ended in this tick.
    """
    zero = at_rest(context.domain.axes)
    if state.mode is not Mode.EXECUTING:
        return replace(state, command=zero), None
    if state.task.running is None:
        state = _started(context, state)
    running = state.task.running
    if running is None:
        coast = state.coasted < context.settings.coast_ticks
        return replace(state, command=state.command if coast else zero, coasted=state.coasted + 1), None
    running, control = control_step(running, state.now_ns, state.belief)
    command, wrong = checked(control.command, context.domain.axes)
    if wrong:
        control = replace(control, outcome="failed", detail=wrong)
    state = replace(state, command=command, task=replace(state.task, running=running))
    if control.outcome == "running":
        return state, None
    return _ended(context, state, running, control)


def finished_message(
    context: Context, state: State, index: int, running: Running, how: tuple[str, str]
) -> ActionFinished:
    """Report of the task's action number `index` that ends in this tick; `how` is outcome and reason."""
    return ActionFinished(
        stamp_ns=context.stamp(state.now_ns),
        tick=state.tick,
        action=running.action.name,
        action_index=index,
        outcome=how[0],
        reason=how[1],
        predicted_s=running.predicted_s,
        actual_s=running.elapsed_s(state.now_ns),
    )


def _started(context: Context, state: State) -> State:
    decision = state.task.decision
    if decision is None:
        return state
    step = decision.sequence.actions[0].step
    facts = context.domain.anchor(state.belief, context.scenario, state.task.facts)
    missing = _missing_support(decision.plan, step, facts)
    if missing is not None:
        return replace(state, task=replace(state.task, decision=None), deliberation=None)
    return replace(state, task=replace(state.task, running=first_action(decision, state.now_ns)), coasted=0)


def _missing_support(plan: planning.Plan, step: int, facts: frozenset[Fact]) -> planning.Literal | None:
    """A precondition that the plan took from the initial state and that no longer holds."""
    for link in plan.links_to(step):
        if link.producer == 0 and (link.literal.fact in facts) is not link.literal.positive:
            return link.literal
    return None


def _ended(context: Context, state: State, running: Running, control: Control) -> tuple[State, ActionFinished | None]:
    task = replace(state.task, running=None, decision=None, finished=state.task.finished + 1)
    finished = finished_message(context, state, state.task.finished, running, (control.outcome, control.detail))
    state = replace(state, deliberation=None, coasted=0)
    if control.outcome == "done":
        return replace(state, task=_with_effects(context, replace(task, failures=()), running)), finished
    failures = (*task.failures, f"{running.action.name}: {control.detail}")
    task = replace(task, failures=failures, plan=None, done=frozenset())
    zero = at_rest(context.domain.axes)
    fault = failures[-1] if failures.count(failures[-1]) >= context.settings.replan_failures else ""
    state = replace(state, task=task, fault=fault, command=zero, coasted=context.settings.coast_ticks)
    return state, finished


def _with_effects(context: Context, task: Task, running: Running) -> Task:
    """The abstract state after a plan step is done; an asserted subgoal does not change it."""
    if running.asserted or task.plan is None:
        return task
    action = next(step.action for step in task.plan.steps if step.id == running.step)
    facts = planning.apply_action(context.pddl_domain, context.problem, task.facts, action)
    return replace(task, facts=facts, done=task.done | {running.step})
