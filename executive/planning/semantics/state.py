"""States as sets of facts: evaluation of formulas, and the literals that support them."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import (
    And,
    Atom,
    Condition,
    Equal,
    Formula,
    Literal,
    Not,
    Or,
    Quantified,
    Typed,
    When,
    fact_of,
)
from tailor.executive.planning.pddl.problem import Problem

Binding = Mapping[str, str]
State = frozenset[Fact]
PORTION_PARTS = 128  # parts of formulas, or objects tried, in one portion: an eighth of a millisecond


MAX_PARTS = 2_000_000  # of a plan that is to be executed: a few seconds, spread over ticks


class TooLargeError(Exception):
    """The formulas of a plan range over too many objects to be checked."""


@dataclass(frozen=True, slots=True)
class Objects:
    """The objects of a problem, by type, and its initial state.

    `most_parts` limits the work on large formulas, which `spend` counts in their parts.
    """

    problem: Problem
    most_parts: float = math.inf
    initial: State = field(init=False, compare=False, repr=False)
    found: dict[tuple[str, ...], dict[str, None]] = field(default_factory=dict, compare=False, repr=False)
    spent: Counter[str] = field(default_factory=Counter, compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "initial", frozenset(self.problem.initial))

    def of(self, variable: Typed) -> Collection[str]:
        """The objects of a variable's types, in the order of their declaration."""
        if variable.types not in self.found:
            domain = self.problem.domain
            self.found[variable.types] = {
                item.name: None
                for item in (*domain.constants, *self.problem.objects)
                if any(domain.is_a(own, wanted) for own in item.types for wanted in variable.types)
            }
        return self.found[variable.types]

    def bindings(self, variables: tuple[Typed, ...], binding: Binding) -> Iterator[Binding]:
        """All extensions of a binding by objects for the variables."""
        if not variables:
            yield binding
            return
        names = [variable.name for variable in variables]
        for objects in itertools.product(*(self.of(variable) for variable in variables)):
            yield {**binding, **dict(zip(names, objects, strict=True))}

    def paced_bindings(self, variables: tuple[Typed, ...], binding: Binding) -> Iterator[Binding | None]:
        """As `bindings`, with None after every portion.

        Raises:
          TooLargeError: The limit is reached.
        """
        for count, inner in enumerate(self.bindings(variables, binding), 1):
            yield inner
            if not count % PORTION_PARTS:
                self.spend(PORTION_PARTS)
                yield None

    def spend(self, parts: int) -> None:
        """Counts parts of large formulas.

        Raises:
          TooLargeError: There are more of them than the limit.
        """
        self.spent["parts"] += parts
        if self.spent["parts"] > self.most_parts:
            raise TooLargeError(f"its quantifiers have more than {self.most_parts:.0f} instances, too many to check")


def holds(formula: Formula, binding: Binding, state: State, objects: Objects) -> bool:
    """Whether a formula holds in a state."""
    match formula:
        case Atom():
            return fact_of(formula, binding) in state
        case Equal(left, right):
            return binding.get(left, left) == binding.get(right, right)
        case Not(part):
            return not holds(part, binding, state, objects)
        case And(parts):
            return all(holds(part, binding, state, objects) for part in parts)
        case Or(parts):
            return any(holds(part, binding, state, objects) for part in parts)
        case Quantified(every, variables, part):
            results = (holds(part, inner, state, objects) for inner in objects.bindings(variables, binding))
            return all(results) if every else any(results)


def support(formula: Formula, binding: Binding, state: State, objects: Objects) -> list[Literal]:
    """Literals of the state that make a (true) formula hold; of a disjunction those of its first true part."""
    match formula:
        case Atom():
            return [Literal(fact_of(formula, binding))]
        case Equal():
            return []
        case Not(Atom() as atom):
            return [Literal(fact_of(atom, binding), positive=False)]
        case Not(part):
            return support(negation(part), binding, state, objects)
        case And(parts):
            return [literal for part in parts for literal in support(part, binding, state, objects)]
        case Or(parts):
            return support(next(p for p in parts if holds(p, binding, state, objects)), binding, state, objects)
        case Quantified(every, variables, part):
            inner = (b for b in objects.bindings(variables, binding) if every or holds(part, b, state, objects))
            chosen = inner if every else itertools.islice(inner, 1)  # most of the others may never be tried
            return [literal for b in chosen for literal in support(part, b, state, objects)]


def negation(formula: Formula) -> Formula:
    """The negation of a compound formula, with "not" moved inwards."""
    match formula:
        case And(parts):
            return Or(tuple(Not(part) for part in parts))
        case Or(parts):
            return And(tuple(Not(part) for part in parts))
        case Not(part):
            return part
        case Quantified(every, variables, part):
            return Quantified(not every, variables, Not(part))
        case _:
            return And(())  # an (in)equality requires no support


def conditions_at(conditions: tuple[Condition, ...], when: When) -> And:
    """The conjunction of an action's conditions at one moment."""
    return And(tuple(condition.formula for condition in conditions if condition.when == when))
