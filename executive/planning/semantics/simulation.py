"""Simulates a sound plan and records, for each event, its requirements and their sources.

Checks nothing: the plan has passed the validator.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from tailor.executive.planning.pddl.language import Action, Domain, Effect, Formula, Literal, Not, When, fact_of
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import GOAL, Plan
from tailor.executive.planning.plans.portions import Work
from tailor.executive.planning.semantics.large_formulas import holding, supporting
from tailor.executive.planning.semantics.state import Binding, Objects, State


@dataclass(frozen=True, slots=True)
class Source:
    """The last event that made a literal true: its step (0: initial state or timed literal) and position."""

    step: int
    position: int  # index of the event
    conditions: tuple[Requirement, ...] = ()  # of the conditional effect


@dataclass(frozen=True, slots=True)
class Requirement:
    """A literal that an event requires, and its source."""

    literal: Literal
    source: Source


@dataclass(frozen=True, slots=True)
class Event:
    """A step's start or end, or both if the action takes no time; the last event is the goal's.

    `prevented` maps literals of conditional effects that did not happen to the requirements of that.
    """

    step: int
    requirements: tuple[Requirement, ...]
    prevented: Mapping[Literal, tuple[Requirement, ...]]


START = Source(0, -1)  # of every literal of the initial state, true or false by closed world


@dataclass(slots=True)
class _World:
    """The state at one point of the simulation, and the source of each literal that has changed."""

    objects: Objects
    state: State
    sources: dict[Literal, Source] = field(default_factory=dict)

    def requirements(self, formulas: Iterable[Formula], binding: Binding) -> Work[tuple[Requirement, ...]]:
        """The literals that make the (true) formulas hold, each once."""
        literals: dict[Literal, None] = {}
        for formula in formulas:
            literals.update(dict.fromkeys((yield from supporting(formula, binding, self.state, self.objects))))
        return tuple(Requirement(literal, self.sources.get(literal, START)) for literal in literals)

    def holds(self, formula: Formula, binding: Binding) -> Work[bool]:
        """Whether a formula holds in this state."""
        return holding(formula, binding, self.state, self.objects)

    def changed(self, achieved: Mapping[Literal, Source]) -> _World:
        """The world after an event."""
        removed = {literal.fact for literal in achieved if not literal.positive}
        added = {literal.fact for literal in achieved if literal.positive}
        return _World(self.objects, (self.state - removed) | added, {**self.sources, **achieved})


@dataclass(frozen=True, slots=True)
class _Moment:
    """Time and place of an event in the schedule."""

    time: float
    rank: int  # at one time ends come before starts, except the end of a step of no duration
    step: int
    moments: tuple[When, ...]
    timed: Literal | None = None


def simulate(plan: Plan, domain: Domain, objects: Objects) -> Work[list[Event]]:
    """The events of a plan, timed literals among them, and the goal; one portion for each event."""
    problem = objects.problem
    schemata = {action.name: action for action in domain.actions}
    steps = {step.id: step for step in plan.steps}
    world = _World(objects, objects.initial)
    began: dict[int, _World] = {}  # world just before each step
    events: list[Event] = []
    for position, moment in enumerate(_moments(plan, schemata, problem)):
        if moment.timed is not None:
            world = world.changed({moment.timed: Source(0, position)})
            events.append(Event(0, (), {}))
            continue
        step = steps[moment.step]
        action = schemata[step.action[0]]
        binding = {p.name: a for p, a in zip(action.parameters, step.action[1:], strict=True)}
        before = began.setdefault(step.id, world)
        achieved, prevented = yield from _effects(action, binding, moment, position, before, world)
        met = _formulas(action, [when for when in moment.moments if when != "over"])
        requirements = yield from world.requirements(met, binding)
        world = world.changed(achieved)
        if "over" in moment.moments:
            lasting = []
            for formula in _formulas(action, ["over"]):  # of a step that takes no time they may fail
                if (yield from world.holds(formula, binding)):
                    lasting.append(formula)
            requirements += yield from world.requirements(lasting, binding)
        events.append(Event(step.id, requirements, prevented))
        yield
    return [*events, Event(GOAL, (yield from world.requirements([problem.goal], {})), {})]


def _moments(plan: Plan, schemata: Mapping[str, Action], problem: Problem) -> list[_Moment]:
    whole: tuple[When, ...] = ("start", "over", "end")
    moments = [_Moment(t.time_s, 0, 0, (), t.literal) for t in problem.timed]
    for step in plan.steps:
        if not plan.durative or schemata[step.action[0]].duration is None:
            moments.append(_Moment(step.start, 1, step.id, whole))
        else:
            moments.append(_Moment(step.start, 1, step.id, ("start", "over")))
            moments.append(_Moment(step.start + step.duration, 0 if step.duration else 2, step.id, ("end",)))
    return sorted(moments, key=lambda moment: (moment.time, moment.rank))  # as the validator has them


def _formulas(action: Action, moments: Collection[When]) -> list[Formula]:
    return [condition.formula for condition in action.conditions if condition.when in moments]


def _effects(
    action: Action, binding: Binding, moment: _Moment, position: int, before: _World, now: _World
) -> Work[tuple[dict[Literal, Source], dict[Literal, tuple[Requirement, ...]]]]:
    """The literals that an event makes true (adds before deletes) with their sources, and those it prevents.

    Args:
      action: Action of the step.
      binding: Objects of its parameters.
      moment: The event.
      position: Index of the event.
      before: World before the step: conditions at start are evaluated there.
      now: World before the event.
    """
    achieved: dict[Literal, Source] = {}
    prevented: dict[Literal, tuple[Requirement, ...]] = {}
    for effect in sorted(action.effects, key=lambda effect: not effect.positive):
        if effect.when not in moment.moments:
            continue
        for inner in now.objects.paced_bindings(effect.variables, binding):
            if inner is None:
                yield
                continue
            literal = Literal(fact_of(effect.atom, inner), effect.positive)
            failing = yield from _failing_condition(effect, inner, before, now)
            if failing is not None:
                prevented[literal] = prevented.get(literal, ()) + failing
            elif literal not in achieved and (effect.positive or Literal(literal.fact) not in achieved):
                conditions = yield from _conditions(effect, inner, before, now)
                if not effect.positive:  # an add effect of the same event would have won
                    conditions += prevented.get(Literal(literal.fact), ())
                achieved[literal] = Source(moment.step, position, conditions)
    return achieved, prevented


def _failing_condition(
    effect: Effect, binding: Binding, before: _World, now: _World
) -> Work[tuple[Requirement, ...] | None]:
    """Requirements of the negation of an effect's first failing condition; None if all conditions hold."""
    for condition in effect.condition:
        world = before if condition.when == "start" else now
        if not (yield from world.holds(condition.formula, binding)):
            return (yield from world.requirements([Not(condition.formula)], binding))
    return None


def _conditions(effect: Effect, binding: Binding, before: _World, now: _World) -> Work[tuple[Requirement, ...]]:
    """Requirements of the conditions of a conditional effect that happens."""
    found: tuple[Requirement, ...] = ()
    for condition in effect.condition:
        world = before if condition.when == "start" else now
        found += yield from world.requirements([condition.formula], binding)
    return found
