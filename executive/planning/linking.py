"""Builds causal links, and the orderings that they need, for a plan whose steps stand in a sound order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from executive.planning.language import Action, Domain, Literal, When
from executive.planning.plan import GOAL, Link, Plan, Step
from executive.planning.problem import Problem
from executive.planning.state import Binding, Objects, State, fact_of, holds, support


@dataclass(frozen=True, slots=True)
class _Moment:
    """A step's start or end, or both at once when actions take no time."""

    time: float
    rank: int  # at one time ends come first
    step: Step
    moments: tuple[When, ...]


def _moments(plan: Plan) -> list[_Moment]:
    if not plan.durative:
        return [_Moment(float(n), 0, step, ("start", "over", "end")) for n, step in enumerate(plan.steps)]
    starts = [_Moment(step.start, 1, step, ("start", "over")) for step in plan.steps]
    ends = [_Moment(step.start + step.duration, 0, step, ("end",)) for step in plan.steps]
    return sorted(starts + ends, key=lambda moment: (round(moment.time, 6), moment.rank))


def links_of(plan: Plan, domain: Domain, problem: Problem) -> Iterator[Link]:
    """Each condition's literals linked to whoever made them true last; of a consumer the last condition first."""
    objects, state = Objects(problem), frozenset(problem.initial)
    producers: dict[Literal, int] = {}  # the initial state for what is not in it
    for moment in _moments(plan):
        step = moment.step
        action = next(action for action in domain.actions if action.name == step.action[0])
        binding = {p.name: a for p, a in zip(action.parameters, step.action[1:], strict=True)}
        needed = _support(action, binding, tuple(w for w in moment.moments if w != "over"), state, objects)
        made = _effects(action, binding, moment, state, objects)
        later = frozenset(state - {x.fact for x in made if not x.positive}) | {x.fact for x in made if x.positive}
        if "over" in moment.moments:
            needed += _support(action, binding, ("over",), later if plan.durative else state, objects)
        yield from (Link(producers.get(x, 0), x, step.id) for x in reversed(needed) if producers.get(x) != step.id)
        producers.update(dict.fromkeys(made, step.id))
        state = later
    goal = dict.fromkeys(support(problem.goal, {}, state, objects))
    yield from (Link(producers.get(literal, 0), literal, GOAL) for literal in reversed(goal))


def _support(
    action: Action, binding: Binding, moments: tuple[When, ...], state: State, objects: Objects
) -> list[Literal]:
    formulas = [condition.formula for condition in action.conditions if condition.when in moments]
    return list(dict.fromkeys(literal for f in formulas for literal in support(f, binding, state, objects)))


def _effects(action: Action, binding: Binding, moment: _Moment, state: State, objects: Objects) -> list[Literal]:
    """The literals that a moment makes true; add effects win over delete effects."""
    instant = action.duration is None and moment.rank == 0
    active = [e for e in action.effects if e.when in moment.moments or instant]
    literals = {
        Literal(fact_of(effect.atom, inner), effect.positive)
        for effect in active
        for inner in objects.bindings(effect.variables, binding)
        if all(holds(condition.formula, inner, state, objects) for condition in effect.condition)
    }
    return sorted(
        (x for x in literals if x.positive or Literal(x.fact) not in literals), key=lambda x: (x.fact, x.positive)
    )


# --- orderings -----------------------------------------------------------------------------------
def orderings_for(plan: Plan, links: tuple[Link, ...], domain: Domain, problem: Problem) -> Iterator[tuple[int, int]]:
    """Pairs that the links need: producer before consumer, and who undoes a link on its side of it."""
    if plan.durative:  # the schedule as it stands
        yield from ((a.id, b.id) for a in plan.steps for b in plan.steps if a.start + a.duration <= b.start)
        return
    order = {0: -1, GOAL: len(plan.steps), **{step.id: n for n, step in enumerate(plan.steps)}}
    undone = {step.id: _undone(step, domain, problem) for step in plan.steps}
    for link in links:
        if link.producer != 0 and link.consumer != GOAL:
            yield link.producer, link.consumer
        for step in plan.steps:
            if link.literal in undone[step.id] and step.id not in (link.producer, link.consumer):
                if order[step.id] < order[link.producer]:
                    yield step.id, link.producer
                elif order[step.id] > order[link.consumer]:
                    yield link.consumer, step.id


def _undone(step: Step, domain: Domain, problem: Problem) -> frozenset[Literal]:
    """The literals that a step may make false."""
    action = next(action for action in domain.actions if action.name == step.action[0])
    binding = {p.name: a for p, a in zip(action.parameters, step.action[1:], strict=True)}
    return frozenset(
        Literal(fact_of(effect.atom, inner), not effect.positive)
        for effect in action.effects
        for inner in Objects(problem).bindings(effect.variables, binding)
    )
