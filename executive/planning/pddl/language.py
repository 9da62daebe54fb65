"""The PDDL language as values: types, formulas, actions, domains.

Neither reads nor plans. Names are in lower case; a term that begins with "?" is a variable.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from typing import Literal as OneOf

from tailor.executive.interfaces.values import Fact

When = OneOf["start", "over", "end"]  # an action's moments: at start, over all, at end


@dataclass(frozen=True, slots=True)
class Literal:
    """A ground atom or its negation, e.g. of ("robot", "pos1")."""

    fact: Fact
    positive: bool = True

    def __str__(self) -> str:
        atom = f"({' '.join(self.fact)})"
        return atom if self.positive else f"(not {atom})"

    def holds_in(self, facts: Set[Fact]) -> bool:
        """Whether it holds in a state, which lists what is true."""
        return (self.fact in facts) is self.positive


@dataclass(frozen=True, slots=True)
class Typed:
    """A variable or object with the types that it may have; more than one is PDDL's `either`."""

    name: str
    types: tuple[str, ...] = ("object",)


# --- formulas ------------------------------------------------------------------------------------
@dataclass(frozen=True, slots=True)
class Atom:
    """A predicate over terms."""

    predicate: str
    terms: tuple[str, ...]


def fact_of(atom: Atom, binding: Mapping[str, str]) -> Fact:
    """The ground fact that an atom becomes with these objects for its variables."""
    return (atom.predicate, *(binding.get(term, term) for term in atom.terms))


@dataclass(frozen=True, slots=True)
class Equal:
    """Two terms name the same object."""

    left: str
    right: str


@dataclass(frozen=True, slots=True)
class Not:
    """The part does not hold."""

    part: Formula


@dataclass(frozen=True, slots=True)
class And:
    """Every part holds; no parts: true."""

    parts: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Or:
    """Some part holds; no parts: false."""

    parts: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Quantified:
    """The part holds for every choice of the variables, or (`every` false) for some choice."""

    every: bool
    variables: tuple[Typed, ...]
    part: Formula


Formula = Atom | Equal | Not | And | Or | Quantified


# --- numbers -------------------------------------------------------------------------------------
@dataclass(frozen=True, slots=True)
class Number:
    """A constant of a duration."""

    value: float


@dataclass(frozen=True, slots=True)
class Function:
    """A static numeric function over terms."""

    name: str
    terms: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Operation:
    """Arithmetic on two or more numbers, from left to right; a sign is written as 0 - x."""

    operator: OneOf["+", "-", "*", "/"]
    operands: tuple[Numeric, ...]


Numeric = Number | Function | Operation


def numbers_in(value: Numeric) -> int:
    """How many constants and functions an arithmetic expression has."""
    return sum(map(numbers_in, value.operands)) if isinstance(value, Operation) else 1


@dataclass(frozen=True, slots=True)
class DurationBound:
    """One constraint (operator ?duration value) of a durative action."""

    operator: OneOf["=", "<=", ">="]
    value: Numeric


# --- actions -------------------------------------------------------------------------------------
@dataclass(frozen=True, slots=True)
class Condition:
    """A formula that must hold at one moment of an action."""

    formula: Formula
    when: When = "start"


@dataclass(frozen=True, slots=True)
class Effect:
    """One literal that an action makes true, for all choices of `variables` for which `condition` holds.

    No variable hides a parameter or another variable: the reader renames those that do. No condition is over all.
    """

    atom: Atom
    positive: bool
    when: When = "end"
    variables: tuple[Typed, ...] = ()
    condition: tuple[Condition, ...] = ()


@dataclass(frozen=True, slots=True)
class Action:
    """An action schema; `duration` is None for an instantaneous one."""

    name: str
    parameters: tuple[Typed, ...]
    conditions: tuple[Condition, ...]
    effects: tuple[Effect, ...]
    duration: tuple[DurationBound, ...] | None = None
    cost: Numeric | None = None  # by which it increases (total-cost)


# --- domains -------------------------------------------------------------------------------------
@dataclass(frozen=True, slots=True)
class Definition:
    """The formula by which a derived predicate holds, over its parameters; it names no derived predicate."""

    parameters: tuple[Typed, ...]
    formula: Formula


@dataclass(frozen=True, slots=True)
class Domain:
    """A planning domain.

    `types` maps each type to its parents ("object" has none), `ancestors` to itself and all types above it;
    `predicates` and `functions` map names to parameters. Conditions name no predicate of `derived`: the readers put
    its definition in its place.
    """

    name: str
    types: Mapping[str, tuple[str, ...]]
    ancestors: Mapping[str, frozenset[str]]
    constants: tuple[Typed, ...]
    predicates: Mapping[str, tuple[Typed, ...]]
    functions: Mapping[str, tuple[Typed, ...]]
    actions: tuple[Action, ...]
    derived: Mapping[str, Definition] = field(default_factory=dict)

    @property
    def durative(self) -> bool:
        """Whether any action takes time."""
        return any(action.duration is not None for action in self.actions)

    def bound(self, action: Fact) -> tuple[Action, dict[str, str]]:
        """The schema of a ground action of the domain, and the objects of its parameters."""
        schema = next(schema for schema in self.actions if schema.name == action[0])
        return schema, {p.name: name for p, name in zip(schema.parameters, action[1:], strict=True)}

    def is_a(self, kind: str, ancestor: str) -> bool:
        """Whether every object of type `kind` is one of type `ancestor`."""
        return ancestor in self.ancestors[kind]
