"""What the rest of a tick's budget is used for while an action runs: that which follows the action."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.effects import facts_now
from tailor.executive.core.state import State
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Deliberation
from tailor.executive.deliberation.next_choice import NextChoice
from tailor.executive.deliberation.plan_reuse import Preparation
from tailor.executive.interfaces.budget import Budget


def with_next_choice(context: Context, state: State, deliberation: Deliberation) -> State:
    """After a decision that took several ticks: the search for the choice after the running action.

    Where one tick is enough, the next decision will not need it.
    """
    decision, known = state.task.decision, state.next_choice
    if decision is None or state.task.running is None or deliberation.ticks == 1:
        return state
    if known is not None and known.decision is decision:
        return state
    return replace(state, next_choice=NextChoice(context, decision))


def with_budget_used(context: Context, state: State, budget: Budget) -> State:
    """While an action runs and nothing is to be decided: prepare what follows it, then search a better plan."""
    if state.task.running is None:
        return state
    preparation, coming = _preparation(context, state), state.next_choice
    if preparation is not None:
        state = replace(state, preparation=preparation)
        if not preparation.advance_suffix(budget):
            return state
    if coming is not None and coming.decision is state.task.decision:
        coming.advance(budget)
    if preparation is not None:
        preparation.advance(budget)
    return state


def _preparation(context: Context, state: State) -> Preparation | None:
    """That of the plan after the running action, anew where observed facts have changed; None if it ends no step."""
    task, running = state.task, state.task.running
    if running is None or running.asserted or task.plan is None:
        return None
    action = task.plan.action_of(running.step)
    if action is None:
        return None
    facts = facts_now(context, state)
    preparation = state.preparation
    if preparation is None or not preparation.follows(task.plan, running.step, facts):
        expected = planning.apply_action(context.pddl_domain, context.problem, facts, action)
        if preparation is None or not preparation.serves(task.plan, running.step, expected):
            place = (task.plan, running.step, task.done)
            preparation = Preparation(context, *place, expected, task.goal, state.ground)
        preparation.note(facts)
    return preparation
