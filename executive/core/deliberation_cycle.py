"""The life of a deliberation: start, resume, end. Uses what the tick's budget leaves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial

from tailor.executive import planning
from tailor.executive.core.adoption import adopted, failed
from tailor.executive.core.course import (
    HALT_COST_S,
    SEARCH_TICKS,
    halted,
    halted_if_lost,
    risk_of_course,
    shortened,
)
from tailor.executive.core.effects import facts_for_certain, facts_now
from tailor.executive.core.modes import Mode
from tailor.executive.core.spare_budget import with_budget_used, with_next_choice
from tailor.executive.core.state import Inputs, State
from tailor.executive.deliberation.context import Context
from tailor.executive.deliberation.deliberation import Decision, Deliberation
from tailor.executive.deliberation.plan_reuse import reuse
from tailor.executive.deliberation.plan_source import PlanSource, current_problem, request_for
from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.domain_results import anchored
from tailor.executive.interfaces.reasons import Reason, Result
from tailor.executive.interfaces.values import Fact
from tailor.schemas.messages import PlanAnswer, PlanRequest


def pending_request(state: State) -> PlanRequest | None:
    """The request without an answer; a child process that works on any other request may be killed."""
    return state.deliberation.source.request if state.deliberation is not None else None


def receive_answers(context: Context, state: State, inputs: Inputs) -> None:
    """Pass this tick's answers, or a timeout, to the source of the ongoing deliberation; changes it in place."""
    if state.deliberation is None:
        return
    source = state.deliberation.source
    for sample in inputs.samples:
        if isinstance(sample.message, PlanAnswer):
            source.receive(sample.message)
    source.check_timeout(context.stamp(state.now_ns))


def advance_deliberation(context: Context, state: State, budget: Budget) -> State:
    """Start, resume or adopt the result of the deliberation; changes `state.deliberation` in place."""
    if state.mode is not Mode.EXECUTING or state.fault is not None:  # one of this tick, whose mode follows in the next
        return state
    state = _with_deliberation(context, state)
    deliberation = state.deliberation
    if deliberation is None:
        return with_budget_used(context, state, budget)
    if _is_too_late(context, state, deliberation):
        deliberation.settle()
    deliberation.advance(budget)
    state = _with_planner_failure(state, deliberation)
    if deliberation.stage == "failed":
        return failed(context, state, deliberation.failure)
    if deliberation.nothing_to_do():
        return _without_steps(context, state, deliberation)
    decision = deliberation.decision()
    if decision is not None:
        state = adopted(context, state, decision, deliberation.stage == "decided")
    if deliberation.stage == "decided":
        state = with_budget_used(context, with_next_choice(context, state, deliberation), budget)
        deliberation.certify(budget)  # what is left of the budget
    return state


def _without_steps(context: Context, state: State, deliberation: Deliberation) -> State:
    """The state after a plan without steps: achieved, if the facts of now give what it takes from those of its start.

    That was perhaps seconds ago, and the robot may have left since what is only remembered.
    """
    links, task = deliberation.plan.links if deliberation.plan is not None else (), state.task
    if _hold(links, facts_for_certain(context, state)):
        finished = task.finished + (task.running is not None)
        task = replace(task, active=False, result=Result.ACHIEVED, running=None, decision=None, finished=finished)
        return replace(state, task=task)
    without_left = _hold(links, facts_now(context, state))
    return replace(state, task=replace(task, without_left=without_left), deliberation=None)


def _hold(links: Iterable[planning.Link], facts: frozenset[Fact]) -> bool:
    return all(link.literal.holds_in(facts) for link in links)


def _with_deliberation(context: Context, state: State) -> State:
    """A new deliberation if none is ongoing and there is no valid decision, nor a failure in doubt."""
    task, ongoing = state.task, state.deliberation
    if ongoing is not None and ongoing.stage in ("decided", "failed"):
        ongoing = None
    if state.halting is not None:
        return state
    idle = task.running is None and task.decision is None
    if task.running is not None and task.decision is not None:
        state, anew = _on_its_way(context, state, task.decision, ongoing)
        if not anew:
            return state
    elif not idle or ongoing is not None:
        return state
    facts, remembered = facts_now(context, state), anchored(context.domain, state.belief, context.scenario, task.facts)
    if idle and _stays_failed(state, remembered):
        return state
    number = state.deliberations + 1
    source = _source(context, state, current_problem(context, facts, task.goal), number)
    known = state.next_choice if idle else None
    start = known.values() if known is not None and known.decision.plan is task.plan else {}
    deliberation = Deliberation(context, state.belief, state.now_ns, number, source, start)
    return replace(state, deliberation=deliberation, deliberations=number, task=replace(task, facts=remembered))


def _stays_failed(state: State, facts: frozenset[Fact]) -> bool:
    """Whether the last deliberation need not be repeated: at once it would fail again, without a plan also later."""
    task, last = state.task, state.deliberation
    if last is None or last.failure is None or facts != task.facts:
        return False
    return state.now_ns < task.doubted_until_ns or last.failure.reason is Reason.UNSOLVABLE


def _on_its_way(context: Context, state: State, decision: Decision, ongoing: Deliberation | None) -> tuple[State, bool]:
    """The state with the running action as the belief of now leaves it, and whether to deliberate anew."""
    cost_s, risen = risk_of_course(context, state.belief, decision)
    if risen and cost_s > HALT_COST_S:  # also during a search, which may take a second where CPU time is scarce
        return halted(context, state), False
    running, search = state.task.running, None if ongoing is None or _is_followed(state, ongoing) else ongoing
    if running is not None and running.is_lost:
        if search is None or search.ticks >= running.unsupported:  # it began before the fact was missing
            return state, True
        return halted_if_lost(context, state) if search.ticks >= SEARCH_TICKS else state, False
    if search is not None:
        return state, False
    if risen or decision.watch.outdated(state.belief, decision.choice.values):
        return state, True
    return shortened(context, state), False


def _is_followed(state: State, deliberation: Deliberation) -> bool:
    """Whether the running action follows a decision of this deliberation, which may still improve it."""
    task = state.task
    return task.running is not None and task.decision is not None and task.decision.number == deliberation.number


def _is_too_late(context: Context, state: State, deliberation: Deliberation) -> bool:
    """Whether no better subgoal would be adopted any more: the budget is worth more for what follows the action."""
    running = state.task.running
    if running is None or not _is_followed(state, deliberation):
        return False
    return running.elapsed_s(state.now_ns) > context.settings.refine_while_running_s


def _source(context: Context, state: State, problem: planning.Problem, number: int) -> PlanSource:
    """The last plan if it can be reused, else the external planner unless it failed, else the built-in search."""
    task = state.task
    preparation = state.preparation if task.running is None else None
    reused = reuse(context, problem, task.plan, task.done, preparation) if task.plan is not None else None
    external = bool(context.settings.external.command) and not task.external_failed
    request = partial(request_for, context, problem, number) if external else None
    return PlanSource(context, problem, state.ground, context.stamp(state.now_ns), reused, request)


def _with_planner_failure(state: State, deliberation: Deliberation) -> State:
    """A failed external planner gets no more requests until there is a new goal."""
    if state.task.external_failed or not any(result.status == "failed" for result in deliberation.plan_results):
        return state
    return replace(state, task=replace(state.task, external_failed=True))
