"""Quantifiers as PDDL understands them: over a type without objects, "for all" holds and "exists" does not.

unified-planning's simplifier leaves out a variable that the formula does not have, whether its type has objects or not,
and its PDDL writer simplifies every formula.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from unified_planning.model.walkers import Simplifier


class _ExactSimplifier(Simplifier):  # type: ignore[misc]
    """Leaves out variables only where their types have objects; the others stay in their order."""

    def __init__(self, problem: Any) -> None:
        super().__init__(problem.environment)
        self._objects = problem.objects

    def walk_forall(self, expression: Any, args: list[Any]) -> Any:
        """True without objects, the body without variables."""
        return self._quantified(expression, args[0], self.manager.Forall, self.manager.TRUE())

    def walk_exists(self, expression: Any, args: list[Any]) -> Any:
        """False without objects, the body without variables."""
        return self._quantified(expression, args[0], self.manager.Exists, self.manager.FALSE())

    def _quantified(self, expression: Any, body: Any, quantifier: Any, without_objects: Any) -> Any:
        variables = expression.variables()
        types = [variable.type for variable in variables]
        if any(kind.is_user_type() and not any(self._objects(kind)) for kind in types):
            return without_objects
        free = self.environment.free_vars_oracle.get_free_variables(body)
        kept = [variable for variable in variables if variable in free]
        return quantifier(body, *kept) if kept else body


@contextmanager
def exact_quantifiers(problem: Any) -> Iterator[None]:
    """Formulae of the problem's environment are simplified exactly; its writer takes no simplifier of ours."""
    environment = problem.environment
    known, environment._simplifier = environment._simplifier, _ExactSimplifier(problem)
    try:
        yield
    finally:
        environment._simplifier = known
