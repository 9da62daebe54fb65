"""Grounds formulas in portions: a person's goal, or one condition of an action, may hold more than fits into a tick."""

from __future__ import annotations

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
from tailor.executive.planning.pddl.formula_size import parts_of
from tailor.executive.planning.pddl.language import Atom, Equal, Formula, Not, Quantified
from tailor.executive.planning.structures.connectives import FALSE, TRUE

Grounding = Generator[None, None, GroundCondition]  # yields after each portion
PORTION_PARTS = 256  # some milliseconds; the goals of everyday problems have fewer


def ground_in_portions(formula: Formula, world: StaticWorld, facts: FactTable) -> Grounding:
    """The condition, facts and errors of `ground` for a formula without free variables; yields between portions."""
    return Portions(world, facts).ground(formula, {}, True)


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
            parts = parts_of(formula, self.world.choices, PORTION_PARTS)
            known = self._small[id(formula)] = formula, parts <= PORTION_PARTS
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
