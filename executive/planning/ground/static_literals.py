"""The static literals of conditions: grounding removes them, a finished plan links them."""

from __future__ import annotations

from collections.abc import Iterable

from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld
from tailor.executive.planning.pddl.language import And, Atom, Formula, Literal, Not, fact_of


def static_literals(formulas: Iterable[Formula], binding: Binding, world: StaticWorld) -> tuple[Literal, ...]:
    """The static literals that formulas imply, disjunctions ignored; the last one first."""
    literals: list[Literal] = []
    pending = list(formulas)
    while pending:
        part = pending.pop()
        inner, positive = (part.part, False) if isinstance(part, Not) else (part, True)
        if isinstance(part, And):
            pending += part.parts
        elif isinstance(inner, Atom) and inner.predicate in world.static:
            literal = Literal(fact_of(inner, binding), positive)
            if literal not in literals:
                literals.append(literal)
    return tuple(literals)
