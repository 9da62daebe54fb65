"""Formulas with other terms in place of their variables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from tailor.executive.planning.pddl.language import And, Atom, Domain, Equal, Formula, Not, Or, Quantified, Typed


def substituted(formula: Formula, terms: Mapping[str, str]) -> Formula:
    """The formula with a term for each free variable; bound ones are renamed where they would capture such a term.

    Args:
      formula: Its free variables are keys of `terms`, unless these name terms that it does not contain.
      terms: By variable, the term that replaces it.
    """
    if not terms:  # thousands of uses share one formula
        return formula
    match formula:
        case Atom(predicate, names):
            return Atom(predicate, tuple(terms.get(name, name) for name in names))
        case Equal(left, right):
            return Equal(terms.get(left, left), terms.get(right, right))
        case Not(part):
            return Not(substituted(part, terms))
        case And(parts):
            return And(tuple(substituted(part, terms) for part in parts))
        case Or(parts):
            return Or(tuple(substituted(part, terms) for part in parts))
        case Quantified(every, variables, part):
            inner = {name: term for name, term in terms.items() if name not in {v.name for v in variables}}
            renamed = []
            for variable in variables:
                inner[variable.name] = fresh(variable.name, inner.values())
                renamed.append(replace(variable, name=inner[variable.name]))
            return Quantified(every, tuple(renamed), substituted(part, inner))


def narrowed(
    formula: Formula, parameters: Sequence[Typed], given: Iterable[tuple[str, ...]], domain: Domain
) -> Formula:
    """The formula over parameters, false for objects that are of no type of their parameter.

    Args:
      formula: Its free variables are the parameters.
      parameters: Variables with their types.
      given: For each parameter the types of what takes its place; where all are among its own, nothing is tested.
      domain: Domain with all types.
    """
    names = {parameter.name: parameter.name for parameter in parameters}
    for parameter, types in zip(parameters, given, strict=True):
        if not all(any(domain.is_a(kind, own) for own in parameter.types) for kind in types):
            inner = fresh(parameter.name, names)
            part = substituted(formula, {**names, parameter.name: inner})
            formula = Quantified(False, (Typed(inner, parameter.types),), And((Equal(inner, parameter.name), part)))
    return formula


def fresh(name: str, taken: Iterable[str]) -> str:
    """The name, with as many primes as make it differ from those taken."""
    others = frozenset(taken)
    while name in others:
        name += "'"
    return name
