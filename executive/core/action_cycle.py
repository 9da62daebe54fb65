"""The life of an action: start, control, finish, abort. Always runs first in a tick, well under a millisecond."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tailor.executive import planning
from tailor.executive.core.command_guard import at_rest, checked
from tailor.executive.core.context import Context
from tailor.executive.core.deliberation import Decision
from tailor.executive.core.execution import Running, control_step
from tailor.executive.core.modes import Mode
from tailor.executive.core.state import State, Task
from tailor.executive.interfaces.action import Control
from tailor.executive.interfaces.values import Fact
from tailor.schemas.messages import ActionFinished


@dataclass(frozen=True, slots=True)
class Acted:
    """The state after the action part of a tick, and the action that ended in it, if one did."""

    state: State
    finished: ActionFinished | None = None


def act(context: Context, state: State) -> Acted:
    """Advance the running action, or start the one that was decided on, and set the command."""
    zero = at_rest(context.domain.axes)
    if state.mode is not Mode.EXECUTING:
        return Acted(replace(state, command=zero))
    if state.task.running is None:
        state = _started(context, state)
    running = state.task.running
    if running is None:
        coast = state.coasted < context.settings.coast_ticks
        return Acted(replace(state, command=state.command if coast else zero, coasted=state.coasted + 1))
    running, control = control_step(running, state.now_ns, state.belief)
    command, wrong = checked(control.command, context.domain.axes)
    if wrong:
        control = replace(control, outcome="failed", reason=wrong)
    state = replace(state, command=command, task=replace(state.task, running=running))
    if control.outcome == "running":
        return Acted(state)
    return _ended(context, state, running, control)


def ending(context: Context, state: State, index: int, running: Running, how: tuple[str, str]) -> ActionFinished:
    """What is told of an action, the `index`-th of the task, that ends in this tick; `how` is outcome and reason."""
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


def running_from(decision: Decision, now_ns: int) -> Running:
    """The first action of a decision, ready to run with the chosen values."""
    first = decision.sequence.actions[0]
    values = decision.choice.values
    variables = decision.sequence.variables
    parameters = tuple(_value(variables[i].value, values.get(i)) for i in first.variables)
    predicted_s = decision.choice.predicted_s[0]
    return Running(first.action, first.step, first.asserted, parameters, predicted_s, now_ns)


def _value(bound: float | None, chosen: float | None) -> float:
    if bound is not None:
        return bound
    assert chosen is not None, "a free parameter of the next action was not chosen"
    return chosen


def _started(context: Context, state: State) -> State:
    decision = state.task.decision
    if decision is None:
        return state
    step = decision.sequence.actions[0].step
    facts = context.domain.anchor(state.belief, context.scenario, state.task.facts)
    missing = _missing_support(decision.plan, step, facts)
    if missing is not None:
        return replace(state, task=replace(state.task, decision=None), deliberation=None)
    return replace(state, task=replace(state.task, running=running_from(decision, state.now_ns)), coasted=0)


def _missing_support(plan: planning.Plan, step: int, facts: frozenset[Fact]) -> planning.Literal | None:
    """A precondition that the plan took from the initial state and that does not hold any more."""
    for link in plan.links_to(step):
        if link.producer == 0 and (link.literal.fact in facts) is not link.literal.positive:
            return link.literal
    return None


def _ended(context: Context, state: State, running: Running, control: Control) -> Acted:
    task = replace(state.task, running=None, decision=None, finished=state.task.finished + 1)
    finished = ending(context, state, state.task.finished, running, (control.outcome, control.reason))
    state = replace(state, deliberation=None, coasted=0)
    if control.outcome == "done":
        return Acted(replace(state, task=_with_effects(context, replace(task, failures=()), running)), finished)
    failures = (*task.failures, f"{running.action.name}: {control.reason}")
    task = replace(task, failures=failures, plan=None, done=frozenset())
    zero = at_rest(context.domain.axes)
    fault = failures[-1] if failures.count(failures[-1]) >= context.settings.replan_failures else ""
    return Acted(replace(state, task=task, fault=fault, command=zero, coasted=context.settings.coast_ticks), finished)


def _with_effects(context: Context, task: Task, running: Running) -> Task:
    """The abstract state after a plan step is done; an asserted subgoal changes nothing in it."""
    if running.asserted or task.plan is None:
        return task
    action = next(step.action for step in task.plan.steps if step.id == running.step)
    facts = planning.apply_action(context.pddl_domain, context.problem, task.facts, action)
    return replace(task, facts=facts, done=task.done | {running.step})
