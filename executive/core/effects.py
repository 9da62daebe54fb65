"""What the plan expects of an action: what it takes away as it begins, what it brings about, what of it is observed."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.execution import Running
from tailor.executive.core.state import State, Task
from tailor.executive.deliberation.context import Context
from tailor.executive.interfaces.domain_results import anchored
from tailor.executive.interfaces.reasons import Cause, Reason
from tailor.executive.interfaces.values import Fact

MAX_SUBGOALS = 30  # reached in a row before one action: each may lead on around objects, but not for ever
MAX_UNCONFIRMED = 10  # times that an action is done without effect; a ball may be kicked away a few times in a row


def begun(context: Context, task: Task, plan: planning.Plan, running: Running) -> Task:
    """The task with an action that begins: from now on it is not where the facts that it takes away have it.

    They stay remembered, as what comes after may need them: a stroke goes on from the waypoint that the arm has left.
    """
    action = served_action(plan, running)
    taken = frozenset[Fact]() if action is None else task.facts - _applied(context, task.facts, action)
    return replace(task, running=running, left=task.left | taken)


def with_effects(context: Context, task: Task, running: Running) -> Task:
    """The abstract state after a plan step is done; an asserted subgoal does not change it."""
    action = planned_action(task.plan, running)
    if action is None:
        return task
    facts = _applied(context, task.facts, action)
    left = (task.left & facts) - _applied(context, task.facts - task.left, action)
    return replace(task, facts=facts, left=left, without_left=False, done=task.done | {running.step})


def facts_now(context: Context, state: State) -> frozenset[Fact]:
    """The abstract state to plan from and to execute plans in: what is observed, and what else is remembered."""
    task = state.task
    return _anchored(context, state, task.facts - task.left if task.without_left else task.facts)


def facts_for_certain(context: Context, state: State) -> frozenset[Fact]:
    """The abstract state by which a goal is achieved: an action that has begun takes away what it will."""
    return _anchored(context, state, state.task.facts - state.task.left)


def _anchored(context: Context, state: State, remembered: frozenset[Fact]) -> frozenset[Fact]:
    return anchored(context.domain, state.belief, context.scenario, remembered)


def _applied(context: Context, facts: frozenset[Fact], action: Fact) -> frozenset[Fact]:
    return planning.apply_action(context.pddl_domain, context.problem, facts, action)


def confirmed(context: Context, state: State, running: Running) -> State:
    """Note whether the effects of an action that is done are observed; a fault if they never are.

    The plan is then the same again: an action whose effects cannot be observed would be repeated for ever.
    """
    task = state.task
    if running.asserted:
        return _reached(state, running)
    action = planned_action(task.plan, running)
    if action is None:
        return state
    task = replace(task, approached=tuple(each for each in task.approached if each != action))
    facts = facts_now(context, replace(state, task=task))
    missing = missing_effects(context, facts, action)
    if not missing:
        others = tuple(each for each in task.unconfirmed if each != action)
        return replace(state, task=replace(task, unconfirmed=others))
    state = replace(state, task=replace(task, unconfirmed=(*task.unconfirmed, action)))
    count = state.task.unconfirmed.count(action)
    detail = f"{' '.join(action)}: done {count} times, and ({' '.join(min(missing))}) is not observed"
    return state if count < MAX_UNCONFIRMED else _repeated(state, detail)


def _reached(state: State, running: Running) -> State:
    """Note an asserted subgoal that was reached; a fault if the action that it was asserted for never follows."""
    task = state.task
    action = served_action(task.plan, running)
    if action is None:
        return state
    state = replace(state, task=replace(task, approached=(*task.approached, action)))
    count = state.task.approached.count(action)
    detail = f"{' '.join(action)}: {count} subgoals reached in a row, and it is still predicted to fail"
    return state if count < MAX_SUBGOALS else _repeated(state, detail)


def _repeated(state: State, detail: str) -> State:
    return replace(state, fault=Cause(Reason.REPEATED_FAILURE, detail))


def planned_action(plan: planning.Plan | None, running: Running) -> Fact | None:
    """The ground action of the plan that the running action serves; None if it leads to an asserted subgoal."""
    return None if running.asserted else served_action(plan, running)


def served_action(plan: planning.Plan | None, running: Running) -> Fact | None:
    """The same, also where the running action leads to a subgoal that was asserted before it."""
    return plan.action_of(running.step) if plan is not None else None


def missing_effects(context: Context, facts: frozenset[Fact], action: Fact) -> frozenset[Fact]:
    """Facts that a ground action brings about and that do not hold."""
    return _applied(context, facts, action) - facts
