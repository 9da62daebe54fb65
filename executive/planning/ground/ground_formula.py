"""Converts formulas to ground conditions: literals are small ints, static facts are folded to true or false.

Literal `2 * i` means that fluent fact number i holds, `2 * i + 1` that it does not: `literal ^ 1` is the negation.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

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
MAX_STEPS = 60_000  # of grounding: no file blocks a robot; counted, so that all machines do the same
INSTANCE_STEPS = 3  # what making an action takes as long as, besides its formulas
MAX_QUANTIFIED = 60_000  # of these below quantifiers: small files can hold bombs; a third of a second


class TooMuchToGround(Exception):
    """Grounding exceeds one of its limits; the message names what is too large."""


class GroundingLimit:
    """Counts the steps of grounding down: converted formulas, and what making an action costs besides.

    `subject` is what is being grounded, for the error; `depth` the number of quantifiers that are being expanded.
    """

    __slots__ = ("_left", "_steps", "depth", "quantified_left", "subject")

    def __init__(
        self, steps: int = MAX_STEPS, quantified: int = MAX_QUANTIFIED, subject: str = "a quantified formula"
    ) -> None:
        self._steps = self._left = steps
        self.quantified_left = quantified
        self.depth = 0
        self.subject = subject

    @property
    def used(self) -> int:
        """The steps spent so far."""
        return self._steps - self._left

    def spend(self, steps: int = 1) -> None:
        """Counts as many more steps.

        Raises:
          TooMuchToGround: A limit is exceeded.
        """
        self._left -= steps
        if self._left < 0:
            raise TooMuchToGround(
                f"grounding takes more than its limit of {self._steps} steps, spent at {self.subject}"
            )
        if self.depth:
            self.quantified_left -= 1
            if self.quantified_left < 0:
                raise TooMuchToGround(f"the quantifiers of {self.subject} range over too many objects")


class FactTable:
    """Numbers fluent facts in the order of their first occurrence; never shrinks."""

    __slots__ = ("_numbers", "limit", "spend")

    def __init__(self, facts: Iterable[Fact] = (), limit: GroundingLimit | None = None) -> None:
        """Numbers the given facts first; `limit` bounds the formulas that may be grounded."""
        self._numbers: dict[Fact, int] = {}
        self.limit = limit if limit is not None else GroundingLimit()
        self.spend = self.limit.spend
        for fact in facts:
            self.literal(fact)

    def __len__(self) -> int:
        return len(self._numbers)

    def __iter__(self) -> Iterator[Fact]:
        return iter(self._numbers)

    def literal(self, fact: Fact, positive: bool = True) -> int:
        """The literal of a fact; a new fact gets the next number."""
        number = self._numbers.setdefault(fact, len(self._numbers))
        return 2 * number + (not positive)

    def names(self) -> tuple[Literal, ...]:
        """The literals by number."""
        return tuple(Literal(fact, positive) for fact in self._numbers for positive in (True, False))


@dataclass(frozen=True, slots=True)
class StaticWorld:
    """The part of a problem that no action changes: objects by type, static facts, values of functions."""

    domain: Domain
    objects: Mapping[str, tuple[str, ...]]  # by type, in the order in which bindings are tried
    static: frozenset[str]  # predicates that no action changes
    facts: frozenset[Fact]  # facts of static predicates that hold
    values: Mapping[Fact, float]  # values of static functions
    temporal: bool  # whether any action takes time
    _either: dict[tuple[str, ...], tuple[str, ...]] = field(default_factory=dict, compare=False, repr=False)

    def choices(self, variable: Typed) -> tuple[str, ...]:
        """The objects of a variable's types."""
        types = variable.types
        if len(types) == 1:
            return self.objects.get(types[0], ())
        if types not in self._either:  # asked for every ground action that has a quantifier
            allowed = {name for kind in types for name in self.objects.get(kind, ())}
            self._either[types] = tuple(name for name in self.objects["object"] if name in allowed)
        return self._either[types]


Binding = Mapping[str, str]


def ground(
    formula: Formula, binding: Binding, world: StaticWorld, facts: FactTable, positive: bool = True
) -> GroundCondition:
    """The ground condition of a formula, in negation normal form.

    Args:
      formula: Formula whose free variables are all bound.
      binding: Object of each variable.
      world: Objects and static facts.
      facts: Numbers of fluent facts; new facts are added.
      positive: False for the formula's negation.

    Raises:
      TooMuchToGround: The table's limit of formulas is reached.
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
    every, pairs = operands(formula, binding, world, positive)
    quantifiers = isinstance(formula, Quantified)
    facts.limit.depth += quantifiers
    condition = joined(every, (ground(part, inner, world, facts, positive) for part, inner in pairs))
    facts.limit.depth -= quantifiers
    return condition


def operands(
    formula: And | Or | Quantified, binding: Binding, world: StaticWorld, positive: bool
) -> tuple[bool, Iterator[tuple[Formula, Binding]]]:
    """Whether every part must hold, else some part; and the parts with their bindings."""
    if isinstance(formula, Quantified):
        part = formula.part
        return formula.every == positive, ((part, inner) for inner in bindings(formula.variables, binding, world))
    return isinstance(formula, And) == positive, ((part, binding) for part in formula.parts)


def joined(every: bool, conditions: Iterable[GroundCondition]) -> GroundCondition:
    """The conjunction, if `every`, or disjunction; the conditions are taken up to the first that decides it."""
    return _consistent(conjunction(conditions)) if every else disjunction(conditions)


def _consistent(condition: GroundCondition) -> GroundCondition:
    """The condition, or FALSE if it is a conjunction of a literal and its negation among others."""
    if isinstance(condition, Conjunction) and contradictory(condition.parts):
        return FALSE
    return condition


def bindings(variables: tuple[Typed, ...], binding: Binding, world: StaticWorld) -> Iterator[Binding]:
    """All extensions of a binding by objects for the variables."""
    if not variables:
        yield binding
        return
    names = [variable.name for variable in variables]
    for objects in itertools.product(*(world.choices(variable) for variable in variables)):
        yield {**binding, **dict(zip(names, objects, strict=True))}


def negation(condition: GroundCondition) -> GroundCondition:
    """The negation of a condition."""
    if isinstance(condition, int):
        return condition ^ 1
    parts = tuple(negation(part) for part in condition.parts)
    return disjunction(parts) if isinstance(condition, Conjunction) else conjunction(parts)


def contradictory(conditions: Iterable[GroundCondition]) -> bool:
    """Whether conditions of one moment include a literal and its negation."""
    literals = {condition for condition in conditions if isinstance(condition, int)}
    return any(literal ^ 1 in literals for literal in literals)
