"""Grounds a goal in portions: a person's goal may hold more than fits into a tick."""

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
from tailor.executive.planning.pddl.language import Atom, Equal, Formula, Not, Quantified
from tailor.executive.planning.structures.connectives import FALSE, TRUE

Grounding = Generator[None, None, GroundCondition]  # yields after each portion
PORTION_PARTS = 256  # some milliseconds; the goals of everyday problems have fewer


def ground_in_portions(formula: Formula, world: StaticWorld, facts: FactTable) -> Grounding:
    """The condition, facts and errors of `ground` for a formula without free variables; yields between portions."""
    return _Portions(world, facts).ground(formula, {}, True)


class _Portions:
    """Counts the parts that were ground since the last yield."""

    def __init__(self, world: StaticWorld, facts: FactTable) -> None:
        self._world, self._facts = world, facts
        self._left = PORTION_PARTS

    def ground(self, formula: Formula, binding: Binding, positive: bool) -> Grounding:
        """As `ground_formula.ground`, part by part and in the same order."""
        if isinstance(formula, Atom | Equal):
            return ground(formula, binding, self._world, self._facts, positive)
        self._facts.spend()
        if isinstance(formula, Not):
            return (yield from self.ground(formula.part, binding, not positive))
        every, pairs = operands(formula, binding, self._world, positive)
        quantifiers = isinstance(formula, Quantified)
        self._facts.limit.depth += quantifiers
        conditions: list[GroundCondition] = []
        for part, inner in pairs:
            self._left -= 1
            if not self._left:
                self._left = PORTION_PARTS
                yield
            conditions.append((yield from self.ground(part, inner, positive)))
            if conditions[-1] == (FALSE if every else TRUE):
                break
        self._facts.limit.depth -= quantifiers
        return joined(every, conditions)
