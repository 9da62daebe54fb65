"""Converts PDDL formulas to lifted ones: "exists" becomes a variable, "forall" is expanded over the objects."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping
from typing import TypeVar

from tailor.executive.planning.ground.ground_formula import GroundingLimit, StaticWorld, bindings
from tailor.executive.planning.lifted.formula import LiftedFormula, LiftedLiteral, equality
from tailor.executive.planning.pddl.language import And, Atom, Equal, Formula, Not, Or, Quantified, Typed
from tailor.executive.planning.structures.connectives import FALSE, conjunction, disjunction

R = TypeVar("R")
Paced = Generator[None, None, R]  # yields after each portion
PORTION_STEPS = 512  # formulas: some milliseconds
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
        self._paused = limit.used

    def lift(self, formula: Formula, names: Names, positive: bool = True) -> Paced[LiftedFormula]:
        """The lifted formula; with `positive` false, that of the negation. Yields after each portion.

        Raises:
          TooMuchToGround: "forall" over many objects exceeds the limit of formulas.
        """
        self._limit.spend()
        if self.is_due():
            yield
        match formula:
            case Atom(predicate, terms):
                return LiftedLiteral(predicate, tuple(names.get(term, term) for term in terms), positive)
            case Equal(left, right):
                return equality(names.get(left, left), names.get(right, right), positive)
            case Not(part):
                return (yield from self.lift(part, names, not positive))
            case And(parts) | Or(parts):
                lifted: dict[LiftedFormula, None] = {}  # each once
                for part in parts:
                    lifted[(yield from self.lift(part, names, positive))] = None
                return conjunction(lifted) if isinstance(formula, And) == positive else disjunction(lifted)
            case Quantified(every, variables, part):
                if every == positive:
                    return (yield from self._all(variables, part, names, positive))
                return (yield from self._some(variables, part, names, positive))

    def is_due(self) -> bool:
        """Whether a portion has been done since this was last true."""
        due = self._limit.used - self._paused >= PORTION_STEPS
        if due:
            self._paused = self._limit.used
        return due

    def spend(self, steps: int = 1) -> None:
        """Counts what takes as long as so many more formulas.

        Raises:
          TooMuchToGround: The limit is exceeded.
        """
        self._limit.spend(steps)

    def choices(self, variables: tuple[Typed, ...], names: Names, steps: int = 1) -> Iterator[Names]:
        """All extensions of the names by objects for the variables; each counts as so many formulas."""
        for inner in bindings(variables, names, self._world):
            self._limit.spend(steps)
            yield inner

    def _all(self, variables: tuple[Typed, ...], part: Formula, names: Names, positive: bool) -> Paced[LiftedFormula]:
        lifted: list[LiftedFormula] = []
        for inner in self.choices(variables, names):
            lifted.append((yield from self.lift(part, inner, positive)))
            if lifted[-1] == FALSE:
                break
        return conjunction(lifted)

    def _some(self, variables: tuple[Typed, ...], part: Formula, names: Names, positive: bool) -> Paced[LiftedFormula]:
        if not all(self._world.choices(variable) for variable in variables):
            return FALSE
        fresh = {variable.name: f"?v{next(self._numbers)}" for variable in variables}
        self.variables += [Typed(fresh[variable.name], variable.types) for variable in variables]
        return (yield from self.lift(part, {**names, **fresh}, positive))
