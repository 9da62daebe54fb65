"""The events of a finished plan, as far as they may interfere: what each reads and changes.

Two events interfere if one changes what the other reads, or undoes what it adds (no moving targets: Fox & Long,
PDDL 2.1, JAIR 20 (2003)).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld, bindings
from tailor.executive.planning.ground_plans.guards import Guards
from tailor.executive.planning.ground_plans.mentions import Changed, by_predicate, chosen, mentioned, terms_of
from tailor.executive.planning.pddl.language import Action, Effect, fact_of
from tailor.executive.planning.pddl.problem import Problem, TimedLiteral
from tailor.executive.planning.structures.orderings import FIRST


class Event(NamedTuple):
    """The facts that a start, an end or a timed literal reads, adds and removes, as far as it may.

    `reads` are those among the facts that some event changes: a quantifier may range over millions of others.
    `uncertain` are changed under a condition alone, which may not hold, or both added and removed.
    """

    reads: frozenset[Fact] = frozenset()
    added: frozenset[Fact] = frozenset()
    removed: frozenset[Fact] = frozenset()
    uncertain: frozenset[Fact] = frozenset()

    def interferes(self, other: Event) -> bool:
        """Whether the two must not happen at the same time."""
        return not (
            self.reads.isdisjoint(other.added | other.removed)
            and other.reads.isdisjoint(self.added | self.removed)
            and self.added.isdisjoint(other.removed)
            and other.added.isdisjoint(self.removed)
        )

    def alone(self) -> Event:
        """The event such that others that change one of its facts interfere with it, even alike."""
        return self._replace(reads=self.reads | self.added | self.removed)

    def certain(self) -> Event:
        """The event without the changes that may not happen."""
        return self._replace(added=self.added - self.uncertain, removed=self.removed - self.uncertain)


class _Moments(NamedTuple):
    """The moments of a step that one event covers; the nodes of the event, and of the step's start."""

    schema: Action
    binding: Binding
    moments: tuple[str, ...]
    node: int
    start: int


def events_of(names: Sequence[Fact], problem: Problem, world: StaticWorld, late: tuple[int, ...]) -> list[Event]:
    """The events of the timed literals and of the steps, in the order of their nodes.

    Args:
      names: The actions of the steps, in the order of their nodes.
      problem: Initial state and timed literals.
      world: Objects and schemata of the actions.
      late: By node, the mask of the nodes that cannot come before it.
    """
    first = FIRST + len(problem.timed)
    parts = [part for n, name in enumerate(names) for part in _both_ends(name, first + 2 * n, world)]
    literals, steps = [_literal(each) for each in problem.timed], [_changes(part, world) for part in parts]
    if any(event.uncertain for event in steps):
        guards = Guards([event.added | event.removed for event in (*literals, *steps)], late, problem, world)
        steps = [_changes(part, world, guards) for part in parts]
    changed = by_predicate(fact for event in (*literals, *steps) for fact in event.added | event.removed)
    reading = zip(steps, parts, strict=True)
    events = [*literals, *(event._replace(reads=_reads(part, changed, world)) for event, part in reading)]
    return [event.alone() for event in events] if problem.changes_apart else events


def _literal(timed: TimedLiteral) -> Event:
    facts = frozenset({timed.literal.fact})
    return Event(added=facts) if timed.literal.positive else Event(removed=facts)


def _both_ends(name: Fact, node: int, world: StaticWorld) -> tuple[_Moments, _Moments]:
    """The start, at that node, and the end of an action; all of one without duration belongs to its start."""
    schema, binding = world.domain.bound(name)
    start, end = (("start", "end"), ()) if schema.duration is None else (("start",), ("end",))
    return _Moments(schema, binding, start, node, node), _Moments(schema, binding, end, node + 1, node)


def _changes(part: _Moments, world: StaticWorld, guards: Guards | None = None) -> Event:
    """The event, without what it reads; without guards each conditional effect may happen."""
    changes: tuple[set[Fact], set[Fact]] = set(), set()
    certain: set[Fact] = set()
    for effect in part.schema.effects:
        if effect.when in part.moments:
            for inner in bindings(effect.variables, part.binding, world):
                happens = _happens(effect, inner, part, guards)
                if happens is not False:
                    fact = fact_of(effect.atom, inner)
                    changes[effect.positive].add(fact)
                    if happens:
                        certain.add(fact)
    removed, added = map(frozenset, changes)
    return Event(added=added, removed=removed, uncertain=((added | removed) - certain) | (added & removed))


def _happens(effect: Effect, binding: Binding, part: _Moments, guards: Guards | None) -> bool | None:
    """Whether an effect of the event happens in every order; None if that is not known."""
    if guards is None or not effect.condition:
        return None if effect.condition else True
    known = [
        guards.holds(condition, binding, part.node if condition.when in part.moments else part.start)
        for condition in effect.condition
    ]
    return False if False in known else None if None in known else True


def _reads(part: _Moments, changed: Changed, world: StaticWorld) -> frozenset[Fact]:
    """The changed facts that an event reads, in conditions of the action or of its effects."""
    terms = terms_of(part.binding)
    read = [(condition, terms) for condition in part.schema.conditions]
    for effect in part.schema.effects:
        if (inner := chosen(effect.variables, terms, world)) is not None:
            read += [(condition, inner) for condition in effect.condition]
    own = ((condition.formula, inner) for condition, inner in read if condition.when in part.moments)
    return frozenset(fact for formula, inner in own for fact in mentioned(formula, inner, changed, world))
