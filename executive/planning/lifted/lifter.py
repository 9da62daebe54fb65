"""Converts PDDL formulas to lifted ones: "exists" becomes a variable, "forall" is expanded over the objects."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tailor.executive.planning.ground.ground_formula import GroundingLimit, StaticWorld, bindings
from tailor.executive.planning.lifted.formula import LiftedFormula, LiftedLiteral, equality
from tailor.executive.planning.pddl.language import And, Atom, Equal, Formula, Not, Or, Quantified, Typed
from tailor.executive.planning.structures.connectives import FALSE, conjunction, disjunction

Names = Mapping[str, str]  # a formula's variable -> the schema's variable, or an object


class Lifter:
    """Converts the formulas of one schema, or of the goal; collects the variables of "exists"."""

    def __init__(self, world: StaticWorld, numbers: Iterator[int], limit: GroundingLimit) -> None:
        """Starts without variables.

        Args:
          world: Objects by type.
          numbers: Numbers of new variables, unique in the domain.
          limit: Limit of the formulas converted.
        """
        self.variables: list[Typed] = []
        self._world = world
        self._numbers = numbers
        self._limit = limit

    def lift(self, formula: Formula, names: Names, positive: bool = True) -> LiftedFormula:
        """The lifted formula; with `positive` false, that of the negation.

        Raises:
          TooMuchToGround: "forall" over many objects exceeds the limit of formulas.
        """
        self._limit.spend()
        match formula:
            case Atom(predicate, terms):
                return LiftedLiteral(predicate, tuple(names.get(term, term) for term in terms), positive)
            case Equal(left, right):
                return equality(names.get(left, left), names.get(right, right), positive)
            case Not(part):
                return self.lift(part, names, not positive)
            case And(parts) | Or(parts):
                lifted = dict.fromkeys(self.lift(part, names, positive) for part in parts)  # each once
                return conjunction(lifted) if isinstance(formula, And) == positive else disjunction(lifted)
            case Quantified(every, variables, part):
                if every == positive:
                    return conjunction(self.lift(part, inner, positive) for inner in self.choices(variables, names))
                return self._some(variables, part, names, positive)

    def spend(self) -> None:
        """Counts what takes as long as one more formula.

        Raises:
          TooMuchToGround: The limit is exceeded.
        """
        self._limit.spend()

    def choices(self, variables: tuple[Typed, ...], names: Names, steps: int = 1) -> Iterator[Names]:
        """All extensions of the names by objects for the variables; each counts as so many formulas."""
        for inner in bindings(variables, names, self._world):
            self._limit.spend(steps)
            yield inner

    def _some(self, variables: tuple[Typed, ...], part: Formula, names: Names, positive: bool) -> LiftedFormula:
        if not all(self._world.choices(variable) for variable in variables):
            return FALSE
        fresh = {variable.name: f"?v{next(self._numbers)}" for variable in variables}
        self.variables += [Typed(fresh[variable.name], variable.types) for variable in variables]
        return self.lift(part, {**names, **fresh}, positive)
