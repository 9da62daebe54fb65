"""Turns PDDL formulas into lifted ones: "exists" becomes a variable, "forall" is spelled out over the objects."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tailor.executive.planning.ground.ground_formula import FactTable, StaticWorld, bindings
from tailor.executive.planning.lifted.formula import LiftedFormula, LiftedLiteral, equality
from tailor.executive.planning.pddl.language import And, Atom, Equal, Formula, Not, Or, Quantified, Typed
from tailor.executive.planning.structures.connectives import FALSE, conjunction, disjunction

Names = Mapping[str, str]  # a formula's variable -> the schema's variable, or an object


class Lifter:
    """Lowers the formulas of one schema, or of the goal; collects the variables that "exists" brings."""

    def __init__(self, world: StaticWorld, numbers: Iterator[int], work: FactTable) -> None:
        """Prepares.

        Args:
          world: Objects by type.
          numbers: Of the variables that come, unique in the domain.
          work: Counts the formulas and stops at its limit.
        """
        self.variables: list[Typed] = []
        self._world = world
        self._numbers = numbers
        self._work = work

    def lowered(self, formula: Formula, names: Names, positive: bool = True) -> LiftedFormula:
        """The lifted formula, or that of the opposite.

        Raises:
          TooMuchToGround: The objects of "forall" make it too long.
        """
        self._work.spend()
        match formula:
            case Atom(predicate, terms):
                return LiftedLiteral(predicate, tuple(names.get(term, term) for term in terms), positive)
            case Equal(left, right):
                return equality(names.get(left, left), names.get(right, right), positive)
            case Not(part):
                return self.lowered(part, names, not positive)
            case And(parts) | Or(parts):
                lowered = (self.lowered(part, names, positive) for part in parts)
                return conjunction(lowered) if isinstance(formula, And) == positive else disjunction(lowered)
            case Quantified(every, variables, part):
                if every == positive:
                    return conjunction(self.lowered(part, inner, positive) for inner in self.choices(variables, names))
                return self._some(variables, part, names, positive)

    def choices(self, variables: tuple[Typed, ...], names: Names) -> Iterator[Names]:
        """All ways to extend the names by objects for the variables."""
        for inner in bindings(variables, names, self._world):
            self._work.spend()
            yield inner

    def _some(self, variables: tuple[Typed, ...], part: Formula, names: Names, positive: bool) -> LiftedFormula:
        if not all(self._world.choices(variable) for variable in variables):
            return FALSE
        fresh = {variable.name: f"?v{next(self._numbers)}" for variable in variables}
        self.variables += [Typed(fresh[variable.name], variable.types) for variable in variables]
        return self.lowered(part, {**names, **fresh}, positive)
