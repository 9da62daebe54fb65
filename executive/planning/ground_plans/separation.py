"""Keeps interfering events apart: as early as possible, events that no ordering relates may fall on the same time.

Two events interfere if one changes what the other reads, or undoes what it adds (no moving targets: Fox & Long,
PDDL 2.1, JAIR 20 (2003)). Causal links separate those that the plan needs; here are the others: conditions of effects
that it does not need, alternatives that it did not choose.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld, bindings
from tailor.executive.planning.pddl.language import Action, And, Atom, Condition, Equal, Formula, Not, Or, Quantified
from tailor.executive.planning.pddl.problem import TimedLiteral
from tailor.executive.planning.structures.orderings import FIRST, Orderings
from tailor.executive.planning.structures.temporal_network import TemporalNetwork


class Event(NamedTuple):
    """The facts that a start, an end or a timed literal reads, adds and removes, as far as it may."""

    reads: frozenset[Fact] = frozenset()
    added: frozenset[Fact] = frozenset()
    removed: frozenset[Fact] = frozenset()

    def interferes(self, other: Event) -> bool:
        """Whether the two must not happen at the same time."""
        return not (
            self.reads.isdisjoint(other.added | other.removed)
            and other.reads.isdisjoint(self.added | self.removed)
            and self.added.isdisjoint(other.removed)
            and other.added.isdisjoint(self.removed)
        )


def separated(
    orderings: Orderings, names: Sequence[Fact], timed: Sequence[TimedLiteral], world: StaticWorld
) -> Orderings | None:
    """The orderings with more of them, so that interfering events are a tick apart at their earliest times.

    Args:
      orderings: Of a plan without flaws: either order of two events that they do not relate is sound.
      names: The actions of the steps, in the order of their nodes.
      timed: The timed literals.
      world: Objects and schemata of the actions.

    Returns:
      None if there is no such schedule. Without durations the steps follow one another: the same orderings.
    """
    if not isinstance(orderings, TemporalNetwork):
        return orderings
    events = [*map(_literal, timed), *(event for name in names for event in _events(name, world))]
    while (pair := _coincident(orderings, events)) is not None:
        further = orderings.ordered(*pair) or orderings.ordered(pair[1], pair[0])
        if further is None:
            return None
        orderings = further
    return orderings


def _coincident(network: TemporalNetwork, events: Sequence[Event]) -> tuple[int, int] | None:
    """The nodes of the first two interfering events that are less than a tick apart."""
    times = network.earliest()
    nodes = sorted(range(FIRST, FIRST + len(events)), key=lambda node: (times[node], node))
    for n, a in enumerate(nodes):
        for b in nodes[n + 1 :]:
            if times[b] - times[a] >= network.tick:
                break
            if events[a - FIRST].interferes(events[b - FIRST]):
                return a, b
    return None


def _literal(timed: TimedLiteral) -> Event:
    facts, none = frozenset({timed.literal.fact}), frozenset[Fact]()
    return Event(none, facts, none) if timed.literal.positive else Event(none, none, facts)


def _events(name: Fact, world: StaticWorld) -> tuple[Event, Event]:
    """The start and the end of an action; all of one without duration belongs to its start."""
    schema = next(action for action in world.domain.actions if action.name == name[0])
    binding = {p.name: argument for p, argument in zip(schema.parameters, name[1:], strict=True)}
    if schema.duration is None:
        return _event(schema, binding, world, ("start", "end")), Event()
    return _event(schema, binding, world, ("start",)), _event(schema, binding, world, ("end",))


def _event(schema: Action, binding: Binding, world: StaticWorld, moments: tuple[str, ...]) -> Event:
    reads = _read(schema.conditions, binding, world, moments)
    changes: tuple[set[Fact], set[Fact]] = set(), set()
    for effect in schema.effects:
        for inner in bindings(effect.variables, binding, world):
            reads.update(_read(effect.condition, inner, world, moments))
            if effect.when in moments:
                changes[effect.positive].update(_facts(effect.atom, inner, world))
    return Event(frozenset(reads), frozenset(changes[True]), frozenset(changes[False]))


def _read(conditions: Sequence[Condition], binding: Binding, world: StaticWorld, moments: Sequence[str]) -> set[Fact]:
    return {fact for c in conditions if c.when in moments for fact in _facts(c.formula, binding, world)}


def _facts(formula: Formula, binding: Binding, world: StaticWorld) -> Iterator[Fact]:
    """The facts that a formula mentions, for all objects of its quantifiers."""
    match formula:
        case Atom(predicate, terms):
            yield (predicate, *(binding.get(term, term) for term in terms))
        case Not(part):
            yield from _facts(part, binding, world)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _facts(part, binding, world)
        case Quantified(_, variables, part):
            for inner in bindings(variables, binding, world):
                yield from _facts(part, inner, world)
        case Equal():
            pass
