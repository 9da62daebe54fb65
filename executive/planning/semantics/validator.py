"""Validates a plan by simulating its events from a problem's initial state. Shares nothing with the search."""

from __future__ import annotations

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.language import Action, Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import Plan, Step
from tailor.executive.planning.plans.portions import Work, completed_work
from tailor.executive.planning.semantics.action_effects import affected
from tailor.executive.planning.semantics.happenings import Event, happenings
from tailor.executive.planning.semantics.interference import reads
from tailor.executive.planning.semantics.large_formulas import holding
from tailor.executive.planning.semantics.link_check import Bound, faulty_link
from tailor.executive.planning.semantics.state import Objects, State, conditions_at
from tailor.executive.planning.semantics.step_check import Unsound, bind_step, check_times


def validate(plan: Plan, domain: Domain, problem: Problem) -> str:
    """Checks that a plan is sound, by simulation from the problem's initial state.

    Args:
      plan: Schedule and causal links of any planner.
      domain: The problem's domain.
      problem: Initial state, timed literals and goal.

    Returns:
      "" if the plan is sound, else the first fault: an unknown action, a wrong duration, no cost, a condition that does
      not hold, two events that interfere, a goal that is not reached, or an unsound causal link.
    """
    return completed_work(validation(plan, domain, Objects(problem)))


def validation(plan: Plan, domain: Domain, objects: Objects) -> Work[str]:
    """`validate` in portions, with the objects and initial state of the problem."""
    problem = objects.problem
    try:
        bound: Bound = {}
        state = yield from _simulate(plan, domain, objects, bound)
        if not (yield from holding(problem.goal, {}, state, objects)):
            return f"the goal {problem.goal_text} does not hold at the end"
    except Unsound as reason:
        return str(reason)
    return (yield from faulty_link(plan, objects, bound))


# --- the simulation ------------------------------------------------------------------------------
def _simulate(plan: Plan, domain: Domain, objects: Objects, bound: Bound) -> Work[State]:
    """The state after the last event; one portion for the events of one time.

    Fills `bound` step by step, as most suffixes of a plan fail at their first.
    """
    state = objects.initial
    running: list[Step] = []
    began: dict[int, State] = {}  # state just before the start of each step
    for events in happenings(plan, objects.problem.timed):
        starting = [event.step for event in events if event.step and event.step.id not in bound]
        for step in starting:
            bound[step.id] = bind_step(step, domain, objects)
            check_times(step, *bound[step.id], objects, plan)
        yield from _check_conditions(events, state, objects, bound)
        began.update((event.step.id, state) for event in events if event.step and not event.ends)
        changes: list[_Change] = []
        for event in events:
            changes.append((event, *(yield from _changes(event, state, began, objects, bound))))
        _check_interference(changes, objects, bound)
        added = frozenset().union(*(more for _, more, _ in changes))
        removed = frozenset().union(*(less for _, _, less in changes))
        state = (state - removed) | added
        running += [event.step for event in events if event.step and not event.ends and plan.durative]
        running = [step for step in running if not any(event.ends and event.step is step for event in events)]
        yield from _check_invariants(running, state, objects, bound)
        yield
    return state


def _moments(event: Event, action: Action) -> tuple[str, ...]:
    """The moments of its action that an event covers; an instantaneous action happens at its start alone."""
    if action.duration is None:
        return () if event.ends else ("start", "end")
    return ("end",) if event.ends else ("start",)


def _check_conditions(events: list[Event], state: State, objects: Objects, bound: Bound) -> Work[None]:
    for event in events:
        when = yield from _unmet(event, state, objects, bound)
        if when and event.step is not None:
            raise Unsound(f"step {event.step.id}: {format_atom(event.step.action)} lacks a condition at its {when}")


def _unmet(event: Event, state: State, objects: Objects, bound: Bound) -> Work[str]:
    """The moment of an event's first condition that fails in a state; "" if all hold."""
    if event.step is None:
        return ""
    action, binding = bound[event.step.id]
    for when in _moments(event, action):
        for condition in action.conditions:
            if condition.when == when and not (yield from holding(condition.formula, binding, state, objects)):
                return when
    return ""


def _check_invariants(running: list[Step], state: State, objects: Objects, bound: Bound) -> Work[None]:
    for step in running:
        action, binding = bound[step.id]
        if not (yield from holding(conditions_at(action.conditions, "over"), binding, state, objects)):
            raise Unsound(f"step {step.id}: {format_atom(step.action)} loses a condition that it needs all the time")


def _changes(
    event: Event, state: State, began: dict[int, State], objects: Objects, bound: Bound
) -> Work[tuple[frozenset[Fact], frozenset[Fact]]]:
    """The facts that an event adds and removes; add effects win over delete effects of the same event."""
    if event.step is None:
        return event.added, event.removed
    action, binding = bound[event.step.id]
    added: set[Fact] = set()
    removed: set[Fact] = set()
    for effect in action.effects:
        if effect.when in _moments(event, action):
            facts = yield from affected(effect, binding, state, objects, began.get(event.step.id, state))
            (added if effect.positive else removed).update(facts)
    return frozenset(added), frozenset(removed - added)


_Change = tuple[Event, frozenset[Fact], frozenset[Fact]]


def _check_interference(changes: list[_Change], objects: Objects, bound: Bound) -> None:
    """Raises if simultaneous events contradict each other, or one changes what another reads (no moving targets)."""
    for event, added, removed in changes if len(changes) > 1 else ():
        changed = added | removed
        for other, more, less in changes:
            if other is event or not changed:
                continue
            alike = objects.problem.changes_apart and other.step is not event.step and changed & (more | less)
            if alike or added & less or removed & more or _is_read(other, changed, objects, bound):
                raise Unsound(f"{event.label} disturbs {other.label} at the same time")


def _is_read(event: Event, facts: frozenset[Fact], objects: Objects, bound: Bound) -> bool:
    if event.step is None:
        return False
    action, binding = bound[event.step.id]
    return reads(action, _moments(event, action), binding, facts, objects)
