"""Goes through a plan's events in order: what each needs, what it makes true and why, what it leaves alone and why.

The plan is sound (the validator has said so); nothing is checked here.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from tailor.executive.planning.pddl.language import Action, Domain, Effect, Formula, Literal, Not, When
from tailor.executive.planning.pddl.problem import Problem
from tailor.executive.planning.plans.plan import GOAL, Plan
from tailor.executive.planning.plans.state import Binding, Objects, State, fact_of, holds, support


@dataclass(frozen=True, slots=True)
class Source:
    """Who made a literal true last: a step (0: the initial state, or a timed literal), and what it took."""

    step: int
    position: int  # of the event
    why: tuple[Need, ...] = ()  # the conditions of the conditional effect


@dataclass(frozen=True, slots=True)
class Need:
    """A literal that holds when it is needed, and its source."""

    literal: Literal
    source: Source


@dataclass(frozen=True, slots=True)
class Event:
    """A step's start or end, or both at once when actions take no time; the last event is the goal's.

    `spared` are the literals that conditional effects would have made true, with what kept these from it.
    """

    step: int
    needs: tuple[Need, ...]
    spared: Mapping[Literal, tuple[Need, ...]]


START = Source(0, -1)  # of every literal that holds at first, true or by closed world


@dataclass(slots=True)
class _World:
    """The state on the way, and the source of each literal that has changed."""

    objects: Objects
    state: State
    sources: dict[Literal, Source] = field(default_factory=dict)

    def needs(self, formulas: Iterable[Formula], binding: Binding) -> tuple[Need, ...]:
        """What makes the (true) formulas hold, each literal once."""
        literals = (x for formula in formulas for x in support(formula, binding, self.state, self.objects))
        return tuple(Need(literal, self.sources.get(literal, START)) for literal in dict.fromkeys(literals))

    def holds(self, formula: Formula, binding: Binding) -> bool:
        """Whether a formula holds now."""
        return holds(formula, binding, self.state, self.objects)

    def changed(self, made: Mapping[Literal, Source]) -> _World:
        """The world after an event."""
        gone = {literal.fact for literal in made if not literal.positive}
        come = {literal.fact for literal in made if literal.positive}
        return _World(self.objects, (self.state - gone) | come, {**self.sources, **made})


@dataclass(frozen=True, slots=True)
class _Moment:
    """When something happens."""

    time: float
    rank: int  # at one time ends come before starts, but for the end of a step without length
    step: int
    moments: tuple[When, ...]
    timed: Literal | None = None


def simulate(plan: Plan, domain: Domain, problem: Problem) -> list[Event]:
    """The events of a plan, timed literals among them, and the goal."""
    schemata = {action.name: action for action in domain.actions}
    steps = {step.id: step for step in plan.steps}
    world = _World(Objects(problem), frozenset(problem.initial))
    began: dict[int, _World] = {}  # by step, the world just before it
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
        made, spared = _effects(action, binding, moment, position, before, world)
        needs = world.needs(_formulas(action, [when for when in moment.moments if when != "over"]), binding)
        world = world.changed(made)
        if "over" in moment.moments:
            needs += world.needs(_formulas(action, ["over"]), binding)
        events.append(Event(step.id, needs, spared))
    return [*events, Event(GOAL, world.needs([problem.goal], {}), {})]


def _moments(plan: Plan, schemata: Mapping[str, Action], problem: Problem) -> list[_Moment]:
    whole: tuple[When, ...] = ("start", "over", "end")
    if not plan.durative:
        return [_Moment(float(n), 0, step.id, whole) for n, step in enumerate(plan.steps)]
    moments = [_Moment(t.time_s, 0, 0, (), t.literal) for t in problem.timed]
    for step in plan.steps:
        if schemata[step.action[0]].duration is None:
            moments.append(_Moment(step.start, 1, step.id, whole))
        else:
            moments.append(_Moment(step.start, 1, step.id, ("start", "over")))
            moments.append(_Moment(step.start + step.duration, 0 if step.duration else 2, step.id, ("end",)))
    return sorted(moments, key=lambda moment: (round(moment.time, 6), moment.rank))


def _formulas(action: Action, moments: Collection[When]) -> list[Formula]:
    return [condition.formula for condition in action.conditions if condition.when in moments]


def _effects(
    action: Action, binding: Binding, moment: _Moment, position: int, before: _World, now: _World
) -> tuple[dict[Literal, Source], dict[Literal, tuple[Need, ...]]]:
    """What an event makes true, adds before deletes, with its source; and what it spares.

    Args:
      action: Of the step.
      binding: Its parameters' objects.
      moment: The event.
      position: Of the event.
      before: The world before the step: what an effect demands at the start is asked there.
      now: The world before the event.
    """
    made: dict[Literal, Source] = {}
    spared: dict[Literal, tuple[Need, ...]] = {}
    for effect in sorted(action.effects, key=lambda effect: not effect.positive):
        if effect.when not in moment.moments:
            continue
        for inner in now.objects.bindings(effect.variables, binding):
            literal = Literal(fact_of(effect.atom, inner), effect.positive)
            failing = _failing(effect, inner, before, now)
            if failing is not None:
                spared[literal] = spared.get(literal, ()) + failing
            elif effect.positive or Literal(literal.fact) not in made:
                why = tuple(
                    need
                    for condition in effect.condition
                    for need in (before if condition.when == "start" else now).needs([condition.formula], inner)
                )
                made.setdefault(literal, Source(moment.step, position, why))
    return made, spared


def _failing(effect: Effect, binding: Binding, before: _World, now: _World) -> tuple[Need, ...] | None:
    """What keeps a conditional effect from happening: the opposite of its first condition that fails; None if none."""
    for condition in effect.condition:
        world = before if condition.when == "start" else now
        if not world.holds(condition.formula, binding):
            return world.needs([Not(condition.formula)], binding)
    return None
