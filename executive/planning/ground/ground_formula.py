"""Turns formulas into ground conditions: literals as small ints, static facts folded to true or false.

Literal `2 * i` says that fluent fact number i holds, `2 * i + 1` that it does not: `literal ^ 1` is the opposite.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import (
    And,
    Atom,
    Domain,
    Equal,
    Formula,
    Literal,
    Not,
    Or,
    Quantified,
    Typed,
)
from tailor.executive.planning.structures.connectives import (
    FALSE,
    TRUE,
    Conjunction,
    Disjunction,
    conjunction,
    disjunction,
)

GroundCondition = int | Conjunction[int] | Disjunction[int]
MAX_FORMULAS = 60_000  # a third of a second of grounding; the competition problems at hand need 20 000


class TooMuchToGround(Exception):
    """Grounding has met more bindings or formulas than it was allowed to."""


class FactTable:
    """Numbers fluent facts in the order in which they are met; only ever grows, and up to a limit of work."""

    def __init__(self, known: Iterable[Fact] = (), limit: int = MAX_FORMULAS) -> None:
        """Starts with known facts; `limit` bounds the formulas that may be grounded."""
        self._numbers: dict[Fact, int] = {}
        self._left = limit
        for fact in known:
            self.literal(fact)

    def spend(self) -> None:
        """One more formula is grounded."""
        self._left -= 1
        if self._left < 0:
            raise TooMuchToGround(
                "grounding met more formulas than its limit; are there quantifiers over many objects?"
            )

    def __len__(self) -> int:
        return len(self._numbers)

    def __iter__(self) -> Iterator[Fact]:
        return iter(self._numbers)

    def literal(self, fact: Fact, positive: bool = True) -> int:
        """The literal of a fact, which gets a number when it has none."""
        number = self._numbers.setdefault(fact, len(self._numbers))
        return 2 * number + (not positive)

    def names(self) -> tuple[Literal, ...]:
        """The literals in words, by number."""
        return tuple(Literal(fact, positive) for fact in self._numbers for positive in (True, False))


@dataclass(frozen=True, slots=True)
class StaticWorld:
    """What stands still while planning: objects by type, and the facts of predicates that no action touches."""

    domain: Domain
    objects: Mapping[str, tuple[str, ...]]  # by type, in the order in which they are tried
    static: frozenset[str]  # predicates
    facts: frozenset[Fact]  # the static ones that hold
    values: Mapping[Fact, float]  # of static functions
    temporal: bool  # whether any action takes time

    def choices(self, variable: Typed) -> tuple[str, ...]:
        """The objects that a variable may stand for."""
        if len(variable.types) == 1:
            return self.objects.get(variable.types[0], ())
        allowed = {name for kind in variable.types for name in self.objects.get(kind, ())}
        return tuple(name for name in self.objects["object"] if name in allowed)


Binding = Mapping[str, str]


def ground(
    formula: Formula, binding: Binding, world: StaticWorld, facts: FactTable, positive: bool = True
) -> GroundCondition:
    """The ground condition that a formula stands for, in negation normal form.

    Args:
      formula: Every free variable of it is in `binding`.
      binding: Variable to object.
      world: Objects and static facts.
      facts: Numbers for fluent facts; new ones are added.
      positive: False for the formula's negation.
    """
    facts.spend()
    match formula:
        case Atom(predicate, terms):
            fact = (predicate, *[binding.get(term, term) for term in terms])
            if predicate in world.static:
                return TRUE if (fact in world.facts) == positive else FALSE
            return facts.literal(fact, positive)
        case Equal(left, right):
            return TRUE if (binding.get(left, left) == binding.get(right, right)) == positive else FALSE
        case Not(part):
            return ground(part, binding, world, facts, not positive)
        case And(parts) | Or(parts):
            grounded = (ground(part, binding, world, facts, positive) for part in parts)
            return conjunction(grounded) if isinstance(formula, And) == positive else disjunction(grounded)
        case Quantified(every, variables, part):
            choices = bindings(variables, binding, world)
            grounded = (ground(part, inner, world, facts, positive) for inner in choices)
            return conjunction(grounded) if every == positive else disjunction(grounded)


def bindings(variables: tuple[Typed, ...], binding: Binding, world: StaticWorld) -> Iterator[Binding]:
    """All ways to extend a binding by objects for the variables."""
    if not variables:
        yield binding
        return
    names = [variable.name for variable in variables]
    for objects in itertools.product(*(world.choices(variable) for variable in variables)):
        yield {**binding, **dict(zip(names, objects, strict=True))}


def negation(condition: GroundCondition) -> GroundCondition:
    """The opposite condition."""
    if isinstance(condition, int):
        return condition ^ 1
    parts = tuple(negation(part) for part in condition.parts)
    return disjunction(parts) if isinstance(condition, Conjunction) else conjunction(parts)


def contradictory(conditions: Iterable[GroundCondition]) -> bool:
    """Whether a literal and its opposite stand among conditions of one moment."""
    literals = {condition for condition in conditions if isinstance(condition, int)}
    return any(literal ^ 1 in literals for literal in literals)
