"""Validates a plan by simulating its events from a problem's initial state. Shares nothing with the search."""

from __future__ import annotations

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.language import Action, Domain
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import Plan, Step
from tailor.executive.planning.plans.portions import Work, completed_work
from tailor.executive.planning.semantics.action_effects import affected
from tailor.executive.planning.semantics.durations import allowed_durations
from tailor.executive.planning.semantics.happenings import Event, happenings
from tailor.executive.planning.semantics.link_check import Bound, faulty_link
from tailor.executive.planning.semantics.state import Binding, Objects, State, conditions_at, holds

SLACK_TICKS = 0.51  # of a duration: other planners print whole ticks
SLACK_S = 1e-7  # of a float


class Unsound(Exception):
    """The reason why a plan is unsound."""


def validate(plan: Plan, domain: Domain, problem: Problem) -> str:
    """Checks that a plan is sound, by simulation from the problem's initial state.

    Args:
      plan: Schedule and causal links of any planner.
      domain: The problem's domain.
      problem: Initial state, timed literals and goal.

    Returns:
      "" if the plan is sound, else the first fault: an unknown action, a wrong duration, a condition that does not
      hold, two events that interfere, a goal that is not reached, or an unsound causal link.
    """
    return completed_work(validation(plan, domain, Objects(problem)))


def validation(plan: Plan, domain: Domain, objects: Objects) -> Work[str]:
    """`validate` in portions, with the objects and initial state of the problem."""
    problem = objects.problem
    try:
        bound: Bound = {}
        state = yield from _simulate(plan, domain, objects, bound)
        if not holds(problem.goal, {}, state, objects):
            return f"the goal {problem.goal_text} does not hold at the end"
    except Unsound as reason:
        return str(reason)
    return (yield from faulty_link(plan, objects, bound))


# --- the actions ---------------------------------------------------------------------------------
def bind_step(step: Step, domain: Domain, objects: Objects) -> tuple[Action, Binding]:
    """The action schema and binding of a step.

    Raises:
      Unsound: No such action, or other arguments than it takes.
    """
    name, *arguments = step.action
    action = next((action for action in domain.actions if action.name == name), None)
    if action is None:
        raise Unsound(f"step {step.id}: the domain has no action '{name}'")
    if len(arguments) != len(action.parameters):
        raise Unsound(f"step {step.id}: '{name}' takes {len(action.parameters)} arguments, not {len(arguments)}")
    for parameter, argument in zip(action.parameters, arguments, strict=True):
        if argument not in objects.of(parameter):
            raise Unsound(f"step {step.id}: '{argument}' is no {' or '.join(parameter.types)}")
    binding = {p.name: a for p, a in zip(action.parameters, arguments, strict=True)}
    return action, binding


def _check_duration(step: Step, action: Action, binding: Binding, objects: Objects, tick_s: float) -> None:
    if action.duration is None:
        return
    allowed = allowed_durations(action.duration, binding, objects.problem.values)
    if allowed is None:
        raise Unsound(f"step {step.id}: {format_atom(step.action)} has no possible duration")
    slack_s = SLACK_TICKS * tick_s + SLACK_S
    if not allowed[0] - slack_s <= step.duration <= allowed[1] + slack_s:
        raise Unsound(f"step {step.id}: {format_atom(step.action)} cannot last {step.duration} s")


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
            _check_duration(step, *bound[step.id], objects, plan.tick_s)
        _check_conditions(events, state, objects, bound)
        began.update((event.step.id, state) for event in events if event.step and not event.ends)
        changes = [(event, *_changes(event, state, began, objects, bound)) for event in events]
        _check_interference(changes, state, objects, bound)
        added = frozenset().union(*(more for _, more, _ in changes))
        removed = frozenset().union(*(less for _, _, less in changes))
        state = (state - removed) | added
        running += [event.step for event in events if event.step and not event.ends and plan.durative]
        running = [step for step in running if not any(event.ends and event.step is step for event in events)]
        _check_invariants(running, state, objects, bound)
        yield
    return state


def _moments(event: Event, action: Action) -> tuple[str, ...]:
    """The moments of its action that an event covers."""
    if action.duration is None:
        return ("start", "end") if event.ends else ()
    return ("end",) if event.ends else ("start",)


def _check_conditions(events: list[Event], state: State, objects: Objects, bound: Bound) -> None:
    for event in events:
        when = _unmet(event, state, objects, bound)
        if when and event.step is not None:
            raise Unsound(f"step {event.step.id}: {format_atom(event.step.action)} lacks a condition at its {when}")


def _unmet(event: Event, state: State, objects: Objects, bound: Bound) -> str:
    """The moment of an event's first condition that fails in a state; "" if all hold."""
    if event.step is None:
        return ""
    action, binding = bound[event.step.id]
    for when in _moments(event, action):
        for condition in action.conditions:
            if condition.when == when and not holds(condition.formula, binding, state, objects):
                return when
    return ""


def _check_invariants(running: list[Step], state: State, objects: Objects, bound: Bound) -> None:
    for step in running:
        action, binding = bound[step.id]
        if not holds(conditions_at(action.conditions, "over"), binding, state, objects):
            raise Unsound(f"step {step.id}: {format_atom(step.action)} loses a condition that it needs all the time")


def _changes(
    event: Event, state: State, began: dict[int, State], objects: Objects, bound: Bound
) -> tuple[frozenset[Fact], frozenset[Fact]]:
    """The facts that an event adds and removes; add effects win over delete effects of the same event."""
    if event.step is None:
        return event.added, event.removed
    action, binding = bound[event.step.id]
    added: set[Fact] = set()
    removed: set[Fact] = set()
    for effect in action.effects:
        if effect.when in _moments(event, action):
            facts = affected(effect, binding, state, objects, began.get(event.step.id, state))
            (added if effect.positive else removed).update(facts)
    return frozenset(added), frozenset(removed - added)


_Change = tuple[Event, frozenset[Fact], frozenset[Fact]]


def _check_interference(changes: list[_Change], state: State, objects: Objects, bound: Bound) -> None:
    """Raises if simultaneous events contradict each other or undo each other's conditions (no moving targets).

    The conditions of an event must hold after each other event alone, and after all others.
    Source: Fox & Long, PDDL 2.1, JAIR 20 (2003).
    """
    if len(changes) == 1:
        return
    for other, more, less in changes:
        others = [change for change in changes if change[0] is not other]
        for event, added, removed in others:
            if added & less or removed & more or _unmet(other, (state - removed) | added, objects, bound):
                raise Unsound(f"{event.label} disturbs {other.label} at the same time")
        all_removed = frozenset[Fact]().union(*(removed for _, _, removed in others))
        all_added = frozenset[Fact]().union(*(added for _, added, _ in others))
        if _unmet(other, (state - all_removed) | all_added, objects, bound):
            raise Unsound(f"what happens at the same time disturbs {other.label}")
