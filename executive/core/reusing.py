"""What the last plan is still good for: its remaining suffix, or a better plan that was looked for meanwhile."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive import planning
from tailor.executive.core.context import Context
from tailor.executive.core.improvement import Improvement, better
from tailor.executive.core.plan_finding import PlanFound
from tailor.executive.core.state import State, Task
from tailor.executive.interfaces.budget import Budget


def reusable(
    context: Context, problem: planning.Problem, task: Task, improvement: Improvement | None
) -> PlanFound | None:
    """A plan that is sound from the problem's initial state and needs no search; None if there is none."""
    if task.plan is None:
        return None
    left = _suffix(task.plan, task.done, context.pddl_domain, problem)
    if improvement is not None and task.running is None:
        found = improvement.plan_from(problem)
        if found is not None and found.plan is not None and (left is None or better(found.plan, left)):
            return found
    return PlanFound("solved", "suffix", left, 0, 0, "") if left is not None else None


def look_further(context: Context, state: State, budget: Budget) -> State:
    """While an action runs and nothing else is to be decided: is there a better plan for what comes after it?"""
    task, running = state.task, state.task.running
    if running is None or running.asserted or task.plan is None or not context.settings.improve_plans:
        return state
    action = next((step.action for step in task.plan.steps if step.id == running.step), None)
    if action is None:
        return state
    facts = context.domain.anchor(state.belief, context.scenario, task.facts)
    improvement = state.improvement
    if improvement is None or not improvement.follows(task.plan, running.step, facts):
        expected = planning.apply_action(context.pddl_domain, context.problem, facts, action)
        if improvement is None or not improvement.serves(task.plan, running.step, expected):
            left = {step.id for step in task.plan.steps} - task.done - {running.step}
            improvement = Improvement(context, task.plan, running.step, left, expected, task.goal, state.ground)
        improvement.note(facts)
    improvement.advance(budget)
    return replace(state, improvement=improvement)


def _suffix(
    previous: planning.Plan, done: frozenset[int], domain: planning.Domain, problem: planning.Problem
) -> planning.Plan | None:
    """The shortest suffix of the last plan that is sound from now: what the world did for us is left out."""
    remaining = [step.id for step in previous.steps if step.id not in done]
    for skipped in range(len(remaining), -1, -1):
        plan = planning.suffix(previous, done | set(remaining[:skipped]), domain, problem)
        if plan is not None:
            return plan
    return None
