"""Finds the suffixes of a sequence of actions that reach the goal, by regression of the goal through them.

Exact where conditions and goal are conjunctions of literals and effects have no conditions; otherwise it does not
apply. It takes time in proportion to the number of steps: to simulate each suffix takes its square.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.pddl.language import Action, And, Atom, Domain, Equal, Formula, Literal, Not, fact_of
from tailor.executive.planning.plans.plan import GOAL, Step
from tailor.executive.planning.plans.portions import Work
from tailor.executive.planning.semantics.state import Binding, Objects


class NotClassical(Exception):
    """A disjunction, a quantifier, a conditional effect or a duration."""


class Regression:
    """The literals that must hold now so that the steps regressed so far reach the goal.

    Args:
      domain: Domain of the steps.
      objects: Objects of the problem, with its initial state and goal.
    """

    def __init__(self, domain: Domain, objects: Objects) -> None:
        self._schemata = {action.name: action for action in domain.actions}
        self._objects = objects
        self._state = objects.initial
        self._needed: set[Literal] = set()
        self._unmet = 0  # of the needed ones
        self._consistent = True  # False: some step undoes what is needed after it
        self._applies = not objects.problem.timed
        self.required: dict[int, dict[Literal, None]] = {}  # literals of each step's conditions, and of the goal's
        self._attempt(GOAL, iter([objects.problem.goal]), {})

    @property
    def possible(self) -> bool:
        """Whether a longer suffix may reach the goal."""
        return self._consistent or not self._applies

    @property
    def exact(self) -> bool:
        """Whether `reached` proves that the steps, one after another, are possible and reach the goal."""
        return self._applies

    @property
    def reached(self) -> bool:
        """Whether all that is needed holds now; True where regression does not apply."""
        return not self._applies or (self._consistent and not self._unmet)

    def add(self, step: Step) -> Work[None]:
        """Regress through one more step, which comes before the earlier ones."""
        action = self._schemata.get(step.action[0])
        if action is None or len(action.parameters) != len(step.action) - 1 or action.duration is not None:
            self._applies = False
            return
        binding = {p.name: label for p, label in zip(action.parameters, step.action[1:], strict=True)}
        if any(effect.condition for effect in action.effects):
            self._applies = False
            return
        yield from self._undo(action, binding)
        self._attempt(step.id, (condition.formula for condition in action.conditions), binding)

    def _undo(self, action: Action, binding: Binding) -> Work[None]:
        """Remove what the action makes true; what it makes false can no longer be had."""
        made: dict[Fact, bool] = {}
        for effect in sorted(action.effects, key=lambda effect: effect.positive):  # add effects win
            for inner in self._objects.paced_bindings(effect.variables, binding):
                if inner is None:
                    yield
                else:
                    made[fact_of(effect.atom, inner)] = effect.positive
        for fact, positive in made.items():
            self._drop(Literal(fact, positive))
            self._consistent &= Literal(fact, not positive) not in self._needed

    def _attempt(self, consumer: int, formulas: Iterator[Formula], binding: Binding) -> None:
        required = self.required.setdefault(consumer, {})
        try:
            for formula in formulas:
                for literal in conjunction(formula, binding):
                    self._need(literal)
                    if literal is not None:
                        required[literal] = None
        except NotClassical:
            self._applies = False

    def _need(self, literal: Literal | None) -> None:
        if literal is None:
            self._consistent = False
        elif literal not in self._needed:
            self._needed.add(literal)
            self._unmet += not self._holds(literal)

    def _drop(self, literal: Literal) -> None:
        if literal in self._needed:
            self._needed.remove(literal)
            self._unmet -= not self._holds(literal)

    def _holds(self, literal: Literal) -> bool:
        return literal.holds_in(self._state)


def conjunction(formula: Formula, binding: Binding) -> Sequence[Literal | None]:
    """The literals of a conjunction; None for one that is false.

    Raises:
      NotClassical: The formula is no conjunction of literals.
    """
    match formula:
        case Atom():
            return [Literal(fact_of(formula, binding))]
        case Not(Atom() as atom):
            return [Literal(fact_of(atom, binding), positive=False)]
        case And(parts):
            return [literal for part in parts for literal in conjunction(part, binding)]
        case Equal(left, right):
            return [] if binding.get(left, left) == binding.get(right, right) else [None]
        case Not(Equal(left, right)):
            return [None] if binding.get(left, left) == binding.get(right, right) else []
        case _:
            raise NotClassical
