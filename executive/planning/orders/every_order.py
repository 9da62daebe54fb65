"""Checks that a partial-order plan is sound in every order of its steps that its orderings allow."""

from __future__ import annotations

from collections.abc import Sequence

from tailor.executive.planning.orders.ground_steps import GroundStep, predecessors
from tailor.executive.planning.orders.truth_criterion import TruthCriterion
from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.language import Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import Plan
from tailor.executive.planning.semantics.regression import NotClassical
from tailor.executive.planning.semantics.state import Objects, State, holds
from tailor.executive.planning.semantics.step_check import Unsound, bind_step

MAX_STATES = 20_000  # of walking through all orders: about a second


class UndecidedError(Exception):
    """Too many orders to walk through."""


def validate_every_order(plan: Plan, domain: Domain, problem: Problem) -> str:
    """Checks that every order of the steps reaches the goal.

    Literals are checked by the truth criterion, in polynomial time. With disjunctions, quantifiers or conditional
    effects all orders are walked through instead, equal states after equal sets of steps once.

    Args:
      plan: A plan without durations; `orderings` are its pairs (before, after) of steps. Start times are ignored.
      domain: The problem's domain, without durative actions.
      problem: Initial state and goal, without timed literals.

    Returns:
      "" if every order is sound, else the first fault.

    Raises:
      UndecidedError: Too many orders to walk through.
      ValueError: The problem has durations or timed literals: of such plans `validate` checks the schedule.
    """
    if domain.durative or problem.timed:
        raise ValueError("a plan with durations has one order, its schedule: use validate")
    objects = Objects(problem)
    try:
        steps = [GroundStep(step, *bind_step(step, domain, objects)) for step in plan.steps]
    except Unsound as fault:
        return str(fault)
    before = predecessors(plan)
    if before is None:
        return "the orderings contain a cycle"
    try:
        return TruthCriterion(steps, before, objects).fault()
    except NotClassical:
        return _walk(steps, before, objects)


def _walk(steps: Sequence[GroundStep], before: Sequence[int], objects: Objects) -> str:
    """The fault of the first order that fails."""
    pending: list[tuple[int, State]] = [(0, objects.initial)]
    seen = set(pending)
    while pending:
        done, state = pending.pop()
        if done == (1 << len(steps)) - 1 and not holds(objects.problem.goal, {}, state, objects):
            return f"the goal {objects.problem.goal_text} does not hold at the end of some order"
        for n, step in enumerate(steps):
            if done >> n & 1 or before[n] & ~done:
                continue
            if not step.applicable(state, objects):
                names = [format_atom(other.step.action) for m, other in enumerate(steps) if done >> m & 1]
                return f"{step} lacks a condition after {', '.join(names) or 'no other step'}"
            then = (done | 1 << n, step.applied(state, objects))
            if then not in seen:
                seen.add(then)
                pending.append(then)
        if len(seen) > MAX_STATES:
            raise UndecidedError(f"more than {MAX_STATES} states of partly executed plans")
    return ""
