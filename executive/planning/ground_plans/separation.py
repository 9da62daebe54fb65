"""Keeps interfering events apart: as early as possible, events that no ordering relates may fall on the same time.

Two events interfere if one changes what the other reads, or undoes what it adds (no moving targets: Fox & Long,
PDDL 2.1, JAIR 20 (2003)). Causal links separate those that the plan needs; here are the others: conditions of effects
that it does not need, alternatives that it did not choose.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import NamedTuple

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld, bindings
from tailor.executive.planning.pddl.language import Action, And, Atom, Equal, Formula, Not, Or, Quantified, Typed
from tailor.executive.planning.pddl.problem import TimedLiteral
from tailor.executive.planning.structures.orderings import FIRST, GOAL, Orderings
from tailor.executive.planning.structures.temporal_network import TemporalNetwork

Pair = tuple[int, int]  # nodes, the first before the second
Choices = list[tuple[Pair, bool]]  # orderings that were added, and whether their opposites are left to try
MAX_REVISED = 200  # orderings added once more after a wrong choice: some milliseconds, nearly all plans need none
Terms = Mapping[str, Sequence[str]]  # the objects that a variable may stand for
Changed = Mapping[str, AbstractSet[Fact]]  # by predicate


class UnsettledError(Exception):
    """The choices between the orders of interfering events that were tried do not tell whether there is a schedule."""


class Schedule(NamedTuple):
    """Orderings with interfering events apart; whether those of no other choice have a smaller makespan."""

    orderings: Orderings
    is_shortest: bool = True


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

    def certain(self) -> Event:
        """The event without the changes that may not happen."""
        return self._replace(added=self.added - self.uncertain, removed=self.removed - self.uncertain)


def separated(
    orderings: Orderings, names: Sequence[Fact], timed: Sequence[TimedLiteral], world: StaticWorld
) -> Schedule | None:
    """The orderings with more of them, so that interfering events are a tick apart at their earliest times.

    Of several the ones with the least makespan, among as many as MAX_REVISED allows.

    Args:
      orderings: Of a plan without flaws: either order of two events that they do not relate is sound.
      names: The actions of the steps, in the order of their nodes.
      timed: The timed literals.
      world: Objects and schemata of the actions.

    Returns:
      None if there is no such schedule. Without durations the steps follow one another: the same orderings.

    Raises:
      UnsettledError: Too many choices failed, or events were kept apart whose effects may not happen.
    """
    if not isinstance(orderings, TemporalNetwork):
        return Schedule(orderings)
    events = _events(names, timed, world)
    network: TemporalNetwork | None = orderings
    shortest: TemporalNetwork | None = None
    chosen: Choices = []
    revised = 0
    is_certain = True  # whether all events that were kept apart must be
    while network is not None:
        if shortest is None or makespan(network) < makespan(shortest):
            pair = _coincident(network, events)
            if pair is not None:
                first, second = (events[node - FIRST].certain() for node in pair)
                is_certain &= first.interferes(second)
            if pair is None:
                shortest = network
            elif (further := _with_pair(network, pair, chosen)) is not None:
                network = further
                continue
        if shortest is not None and makespan(shortest) == makespan(orderings):
            return Schedule(shortest)
        revised += len(chosen)
        if revised > MAX_REVISED:
            if shortest is None:
                raise UnsettledError
            return Schedule(shortest, is_shortest=False)
        network = _with_last_reversed(orderings, chosen)
    if shortest is None and not is_certain:
        raise UnsettledError
    return Schedule(shortest, is_certain) if shortest is not None else None


def makespan(orderings: Orderings) -> float:
    """The earliest time of the goal."""
    return orderings.earliest()[GOAL]


def _with_pair(network: TemporalNetwork, pair: Pair, chosen: Choices) -> TemporalNetwork | None:
    """The orderings with one of two events before the other, in the order given if that fits; None if none does."""
    a, b = pair
    if (further := network.ordered(a, b)) is not None:
        chosen.append(((a, b), True))
    elif (further := network.ordered(b, a)) is not None:
        chosen.append(((b, a), False))
    return further


def _with_last_reversed(orderings: TemporalNetwork, chosen: Choices) -> TemporalNetwork | None:
    """The orderings with the choices up to the last one whose opposite is left to try, reversed; None if none is."""
    while chosen:
        (a, b), is_open = chosen.pop()
        if not is_open:
            continue
        chosen.append(((b, a), False))
        network: TemporalNetwork | None = orderings
        for pair, _ in chosen:
            network = network.ordered(*pair) if network is not None else None
        if network is not None:
            return network
    return None


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


class _Moments(NamedTuple):
    """The moments of a step that one event covers."""

    schema: Action
    binding: Binding
    moments: tuple[str, ...]


def _events(names: Sequence[Fact], timed: Sequence[TimedLiteral], world: StaticWorld) -> list[Event]:
    """The events of the timed literals and of the steps, in the order of their nodes."""
    parts = [part for name in names for part in _both_ends(name, world)]
    literals, steps = [_literal(each) for each in timed], [_changes(part, world) for part in parts]
    changed: dict[str, set[Fact]] = {}
    for event in (*literals, *steps):
        for fact in event.added | event.removed:
            changed.setdefault(fact[0], set()).add(fact)
    reading = zip(steps, parts, strict=True)
    return [*literals, *(event._replace(reads=_reads(part, changed, world)) for event, part in reading)]


def _literal(timed: TimedLiteral) -> Event:
    facts = frozenset({timed.literal.fact})
    return Event(added=facts) if timed.literal.positive else Event(removed=facts)


def _both_ends(name: Fact, world: StaticWorld) -> tuple[_Moments, _Moments]:
    """The start and the end of an action; all of one without duration belongs to its start."""
    schema = next(action for action in world.domain.actions if action.name == name[0])
    binding = {p.name: argument for p, argument in zip(schema.parameters, name[1:], strict=True)}
    start, end = (("start", "end"), ()) if schema.duration is None else (("start",), ("end",))
    return _Moments(schema, binding, start), _Moments(schema, binding, end)


def _changes(part: _Moments, world: StaticWorld) -> Event:
    """The event, without what it reads."""
    changes: tuple[set[Fact], set[Fact]] = set(), set()
    certain: set[Fact] = set()
    for effect in part.schema.effects:
        if effect.when in part.moments:
            for inner in bindings(effect.variables, part.binding, world):
                fact = (effect.atom.predicate, *(inner.get(term, term) for term in effect.atom.terms))
                changes[effect.positive].add(fact)
                if not effect.condition:
                    certain.add(fact)
    removed, added = map(frozenset, changes)
    return Event(added=added, removed=removed, uncertain=((added | removed) - certain) | (added & removed))


def _reads(part: _Moments, changed: Changed, world: StaticWorld) -> frozenset[Fact]:
    """The changed facts that an event reads, in conditions of the action or of its effects."""
    terms: Terms = {name: (value,) for name, value in part.binding.items()}
    read = [(condition, terms) for condition in part.schema.conditions]
    for effect in part.schema.effects:
        if (inner := _chosen(effect.variables, terms, world)) is not None:
            read += [(condition, inner) for condition in effect.condition]
    own = ((condition.formula, inner) for condition, inner in read if condition.when in part.moments)
    return frozenset(fact for formula, inner in own for fact in _mentioned(formula, inner, changed, world))


def _chosen(variables: Iterable[Typed], terms: Terms, world: StaticWorld) -> Terms | None:
    """The terms with variables that stand for all objects of their types; None if there are none for one of them."""
    choices = {variable.name: world.choices(variable) for variable in variables}
    return {**terms, **choices} if all(choices.values()) else None


def _mentioned(formula: Formula, terms: Terms, changed: Changed, world: StaticWorld) -> Iterator[Fact]:
    """The changed facts that a formula mentions, for all objects of its variables."""
    match formula:
        case Atom(predicate, names):
            facts, choices = changed.get(predicate, frozenset()), [terms.get(name, (name,)) for name in names]
            if all(len(objects) == 1 for objects in choices):  # most atoms: no need to look at every fact
                yield from facts & {(predicate, *(name for (name,) in choices))}
            else:
                yield from (fact for fact in facts if _fits(names, fact[1:], choices))
        case Not(part):
            yield from _mentioned(part, terms, changed, world)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _mentioned(part, terms, changed, world)
        case Quantified(_, variables, part):
            if (inner := _chosen(variables, terms, world)) is not None:
                yield from _mentioned(part, inner, changed, world)
        case Equal():
            pass


def _fits(names: Sequence[str], objects: Sequence[str], choices: Sequence[Sequence[str]]) -> bool:
    """Whether names can stand for these objects, of those that each may choose from, and each for one only."""
    chosen = dict(zip(names, objects, strict=True))
    return all(
        chosen[name] == actual and actual in own for name, actual, own in zip(names, objects, choices, strict=True)
    )
