"""The life of an action: start, control, finish, abort. Runs first in each tick and takes well under a millisecond."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.command_guard import whole_command
from tailor.executive.core.effects import begun, confirmed, facts_now, planned_action, served_action, with_effects
from tailor.executive.core.execution import Running, control_step, first_action
from tailor.executive.core.modes import Mode
from tailor.executive.core.state import Inputs, State, Task, undecided
from tailor.executive.deliberation.context import Context
from tailor.executive.interfaces.outlet import at_rest
from tailor.executive.interfaces.reasons import Cause, Reason, Result
from tailor.executive.interfaces.values import Fact
from tailor.schemas.messages import ActionFinished

MAX_FRUITLESS = 5  # equal failures of a ground action before it is done, though others, e.g. its approach, succeed
MAX_FAILURES = 10  # of whatever cause, without a success between them: controllers may name a measured value in each


def act(context: Context, state: State) -> tuple[State, ActionFinished | None]:
    """Advance the running action, or start the first action of the decision, and set the command.

    Returns:
      The state after it, and the report of an action that ended in this tick.
    """
    zero = at_rest(context.domain.axes, state.command)
    if state.carried:
        return _abandoned(context, state)
    if state.mode is not Mode.EXECUTING:
        return replace(state, command=zero), None
    if state.task.running is None:
        state = _started(context, state)
    running = state.task.running
    if running is None:
        coast = state.coasted < context.settings.coast_ticks
        return replace(state, command=state.command if coast else zero, coasted=state.coasted + 1), None
    running, control, failure = control_step(running, state.now_ns, state.belief, context.domain.name)
    command, rejection = whole_command(context.domain, running.action, control.command, state.command)
    state = replace(state, command=command, task=replace(state.task, running=running))
    cause = rejection or failure
    if cause is not None:
        return _failed(context, state, running, cause)
    if control.outcome == "running":
        return state, None
    return _done(context, state, running)


def interrupted(context: Context, before: Task, state: State, inputs: Inputs) -> ActionFinished | None:
    """Report of the action of the task `before` this tick's inputs, which ended it; None if it goes on."""
    if before.running is None or state.task.running is not None:
        return None
    if inputs.goal:
        cause = Cause(Reason.CANCELLED if state.task.result is Result.CANCELLED else Reason.NEW_GOAL)
    elif inputs.stopping:
        cause = Cause(Reason.SHUTDOWN)
    else:
        cause = Cause(Reason.DISARMED, str(state.cause))
    return finished_message(context, state, before.finished, before.running, ("aborted", cause))


def finished_message(
    context: Context, state: State, index: int, running: Running, end: tuple[str, Cause | None]
) -> ActionFinished:
    """Report of the task's action number `index` that ends in this tick; `end` is its outcome with the cause.

    Only an action that its controller has done has no cause.
    """
    outcome, cause = end
    return ActionFinished(
        stamp_ns=context.stamp(state.now_ns),
        tick=state.tick,
        action=running.action.name,
        action_index=index,
        outcome=outcome,
        reason=str(cause.reason) if cause is not None else "",
        predicted_s=running.predicted_s,
        actual_s=running.elapsed_s(state.now_ns),
        detail=cause.bus_detail if cause is not None else running.surprise(state.now_ns),
    )


def _started(context: Context, state: State) -> State:
    decision = state.task.decision
    if decision is None:
        return state
    step = decision.sequence.actions[0].step
    missing = _missing_support(decision.plan, step, facts_now(context, state))
    if missing is not None:
        return replace(state, task=replace(state.task, decision=None), deliberation=None)
    running = first_action(decision, context.models, state.now_ns)
    return replace(state, task=begun(context, state.task, decision.plan, running), coasted=0)


def _missing_support(plan: planning.Plan, step: int, facts: frozenset[Fact]) -> planning.Literal | None:
    """A precondition that the plan took from the initial state and that no longer holds."""
    for link in plan.links_to(step):
        if link.producer == 0 and not link.literal.holds_in(facts):
            return link.literal
    return None


def _done(context: Context, state: State, running: Running) -> tuple[State, ActionFinished]:
    finished = finished_message(context, state, state.task.finished, running, ("done", None))
    # An asserted subgoal is no success of the plan: the action that it was asserted for may fail again and again
    failures = state.task.failures if running.asserted else ()
    served = planned_action(state.task.plan, running)
    fruitless = tuple(each for each in state.task.fruitless if each[0] != served)
    task = replace(after_action(state.task), failures=failures, fruitless=fruitless)
    task = with_effects(context, task, running)
    state = confirmed(context, replace(state, task=task, deliberation=None, coasted=0), running)
    if state.fault is not None:
        state = replace(state, command=at_rest(context.domain.axes, state.command))
    return state, finished


def _failed(context: Context, state: State, running: Running, cause: Cause) -> tuple[State, ActionFinished]:
    """Zero command, no plan; a fault if the action has failed so before, or if nothing has succeeded for long.

    Time limits vary with the start, so their values do not count.
    """
    finished = finished_message(context, state, state.task.finished, running, ("failed", cause))
    failure = (running.action.name, Cause(cause.reason) if cause.reason is Reason.ACTION_TIMEOUT else cause)
    again = state.task.failures.count(failure) + 1 >= context.settings.replan_failures
    state, fruitless = _with_fruitless(state, running, failure[1])
    fault = Cause(Reason.REPEATED_FAILURE, f"{running.action.name}: {cause}")
    state = _with_failure(state, failure, fault, again or fruitless)
    task = replace(after_action(state.task), plan=None, done=frozenset())
    zero, coasted = at_rest(context.domain.axes, state.command), context.settings.coast_ticks
    return replace(state, task=task, deliberation=None, command=zero, coasted=coasted), finished


def _with_fruitless(state: State, running: Running, cause: Cause) -> tuple[State, bool]:
    """The failure noted with the ground action of the plan, and whether that has failed too often before it is done."""
    task = state.task
    action = served_action(task.plan, running)
    if action is None:
        return state, False
    fruitless = (*task.fruitless, (action, cause))
    often = sum(each == action for each, _ in fruitless) >= MAX_FAILURES
    state = replace(state, task=replace(task, fruitless=fruitless))
    return state, often or fruitless.count((action, cause)) >= MAX_FRUITLESS


def _with_failure(state: State, failure: tuple[str, Cause], fault: Cause, at_once: bool = False) -> State:
    """Note a failure; it is a fault at once, or if nothing has succeeded for long."""
    failures = (*state.task.failures, failure)
    state = replace(state, task=replace(state.task, failures=failures))
    return replace(state, fault=fault) if at_once or len(failures) >= MAX_FAILURES else state


def _abandoned(context: Context, state: State) -> tuple[State, ActionFinished | None]:
    """Zero command and nothing decided: all decisions were made for the place from which the robot was carried.

    People may carry it more than once; where its wheels slip at an obstacle, it would be found carried for ever.
    """
    running, index, zero = state.task.running, state.task.finished, at_rest(context.domain.axes, state.command)
    state = replace(undecided(state), command=zero, coasted=context.settings.coast_ticks)
    if running is None:
        return state, None
    name, cause = running.action.name, Cause(Reason.ROBOT_CARRIED)
    state = _with_failure(state, (name, cause), Cause(Reason.REPEATED_FAILURE, f"{name}: {cause}"))
    return state, finished_message(context, state, index, running, ("failed", cause))


def after_action(task: Task) -> Task:
    """The task once its action has ended: nothing runs, nothing is decided."""
    return replace(task, running=None, decision=None, finished=task.finished + 1)
