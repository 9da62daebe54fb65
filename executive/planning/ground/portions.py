"""Grounds a goal in portions: a person's goal may hold more than fits into a tick."""

from __future__ import annotations

from collections.abc import Generator, Iterable

from tailor.executive.planning.ground.ground_formula import (
    Binding,
    FactTable,
    GroundCondition,
    StaticWorld,
    bindings,
    consistent,
    ground,
)
from tailor.executive.planning.pddl.language import And, Formula, Not, Or, Quantified
from tailor.executive.planning.structures.connectives import FALSE, TRUE, conjunction, disjunction

PORTION_PARTS = 256  # some milliseconds; the goals of everyday problems have fewer


def ground_in_portions(
    formula: Formula, world: StaticWorld, facts: FactTable
) -> Generator[None, None, GroundCondition]:
    """The condition, facts and errors of `ground` for a formula without free variables; yields between portions."""
    return _Portions(world, facts).ground(formula, {}, True)


class _Portions:
    """Counts the parts that were ground since the last yield."""

    def __init__(self, world: StaticWorld, facts: FactTable) -> None:
        self._world, self._facts = world, facts
        self._left = PORTION_PARTS

    def ground(self, formula: Formula, binding: Binding, positive: bool) -> Generator[None, None, GroundCondition]:
        """As `ground_formula.ground`, part by part and in the same order."""
        match formula:
            case Not(part):
                self._facts.spend()
                return (yield from self.ground(part, binding, not positive))
            case And(parts) | Or(parts):
                self._facts.spend()
                every = isinstance(formula, And) == positive
                return (yield from self._joined(((part, binding) for part in parts), every, positive))
            case Quantified(universal, variables, part):
                self._facts.spend()
                self._facts.limit.depth += 1
                pairs = ((part, inner) for inner in bindings(variables, binding, self._world))
                condition = yield from self._joined(pairs, universal == positive, positive)
                self._facts.limit.depth -= 1
                return condition
        return ground(formula, binding, self._world, self._facts, positive)

    def _joined(
        self, pairs: Iterable[tuple[Formula, Binding]], every: bool, positive: bool
    ) -> Generator[None, None, GroundCondition]:
        """The conjunction, if `every`, or disjunction of the parts; ends at the first that decides it."""
        conditions: list[GroundCondition] = []
        for part, binding in pairs:
            self._left -= 1
            if not self._left:
                self._left = PORTION_PARTS
                yield
            conditions.append((yield from self.ground(part, binding, positive)))
            if conditions[-1] == (FALSE if every else TRUE):
                return conditions[-1]
        return consistent(conjunction(conditions)) if every else disjunction(conditions)
