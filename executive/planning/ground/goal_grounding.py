"""Grounds formulas in portions: a person's goal, or one condition of an action, may hold more than fits into a tick."""

from __future__ import annotations

import math
from collections.abc import Generator

from tailor.executive.planning.ground.ground_formula import (
    Binding,
    FactTable,
    GroundCondition,
    StaticWorld,
    ground,
    joined,
    operands,
)
from tailor.executive.planning.pddl.language import And, Atom, Equal, Formula, Not, Or, Quantified
from tailor.executive.planning.structures.connectives import FALSE, TRUE

Grounding = Generator[None, None, GroundCondition]  # yields after each portion
PORTION_PARTS = 256  # some milliseconds; the goals of everyday problems have fewer


def ground_in_portions(formula: Formula, world: StaticWorld, facts: FactTable) -> Grounding:
    """The condition, facts and errors of `ground` for a formula without free variables; yields between portions."""
    return Portions(world, facts).ground(formula, {}, True)


def _parts(formula: Formula, world: StaticWorld) -> int:
    """The number of atoms and connectives with all objects for the variables."""
    match formula:
        case Not(part):
            return 1 + _parts(part, world)
        case And(parts) | Or(parts):
            return 1 + sum(_parts(part, world) for part in parts)
        case Quantified(_, variables, part):
            return 1 + _parts(part, world) * math.prod(len(world.choices(variable)) for variable in variables)
        case _:
            return 1


class Portions:
    """Counts the parts that were ground since the last yield."""

    def __init__(self, world: StaticWorld, facts: FactTable) -> None:
        """Begins the first portion."""
        self.world, self.facts = world, facts
        self._left = PORTION_PARTS
        self._small: dict[int, tuple[Formula, bool]] = {}  # by identity: comparing conditions takes as long as they do

    def begin(self) -> None:
        """Begins a portion."""
        self._left = PORTION_PARTS

    def is_due(self, parts: int = 1) -> bool:
        """Whether a portion is full with so many more parts, which begins the next one."""
        self._left -= parts
        if self._left > 0:
            return False
        self._left = PORTION_PARTS
        return True

    def is_small(self, formula: Formula) -> bool:
        """Whether a condition, which many actions share, has no more parts than a portion: it is ground at once."""
        known = self._small.get(id(formula))
        if known is None:
            known = self._small[id(formula)] = formula, _parts(formula, self.world) <= PORTION_PARTS
        return known[1]

    def ground(self, formula: Formula, binding: Binding, positive: bool) -> Grounding:
        """As `ground_formula.ground`, part by part and in the same order."""
        if isinstance(formula, Atom | Equal):
            return ground(formula, binding, self.world, self.facts, positive)
        self.facts.spend()
        if isinstance(formula, Not):
            return (yield from self.ground(formula.part, binding, not positive))
        every, pairs = operands(formula, binding, self.world, positive)
        quantifiers = isinstance(formula, Quantified)
        self.facts.limit.depth += quantifiers
        conditions: list[GroundCondition] = []
        for part, inner in pairs:
            if self.is_due():
                yield
            conditions.append((yield from self.ground(part, inner, positive)))
            if conditions[-1] == (FALSE if every else TRUE):
                break
        self.facts.limit.depth -= quantifiers
        return joined(every, conditions)
