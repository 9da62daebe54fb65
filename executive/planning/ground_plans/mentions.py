"""The facts that a formula mentions, among those that some event of a plan changes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet

from tailor.executive.interfaces.values import Fact
from tailor.executive.planning.ground.ground_formula import Binding, StaticWorld
from tailor.executive.planning.pddl.language import And, Atom, Equal, Formula, Not, Or, Quantified, Typed

Terms = Mapping[str, Sequence[str]]  # the objects that a variable may stand for
Choices = Sequence[Sequence[str]]  # the objects that each term of an atom may stand for
Changed = Mapping[str, AbstractSet[Fact]]  # by predicate


def by_predicate(facts: Iterable[Fact]) -> Changed:
    """The facts as `mentioned` takes them."""
    changed: dict[str, set[Fact]] = {}
    for fact in facts:
        changed.setdefault(fact[0], set()).add(fact)
    return changed


def terms_of(binding: Binding) -> Terms:
    """The terms of a binding: each variable stands for one object."""
    return {name: (value,) for name, value in binding.items()}


def chosen(variables: Iterable[Typed], terms: Terms, world: StaticWorld) -> Terms | None:
    """The terms with variables that stand for all objects of their types; None if there are none for one of them."""
    choices = {variable.name: world.choices(variable) for variable in variables}
    return {**terms, **choices} if all(choices.values()) else None


def atoms_of(formula: Formula, terms: Terms, world: StaticWorld) -> Iterator[tuple[Atom, Choices]]:
    """The atoms of a formula, each with the objects that its terms may stand for."""
    match formula:
        case Atom(_, names):
            yield formula, [terms.get(name, (name,)) for name in names]
        case Not(part):
            yield from atoms_of(part, terms, world)
        case And(parts) | Or(parts):
            if (possible := _undecided(formula, terms)) is not None:
                for part in parts:
                    yield from atoms_of(part, possible, world)
        case Quantified(_, variables, part):
            if (inner := chosen(variables, terms, world)) is not None:
                yield from atoms_of(part, inner, world)
        case Equal():
            pass


def _undecided(formula: And | Or, terms: Terms) -> Terms | None:
    """The terms without objects for which an equality among its parts decides a formula; None if it always does.

    So does one of a conjunction that fails, and one of a disjunction that holds: no fact is read then.
    """
    for part in formula.parts:
        equality = part.part if isinstance(part, Not) else part
        if not isinstance(equality, Equal):
            continue
        left, right = (terms.get(side, (side,)) for side in (equality.left, equality.right))
        common = [name for name in left if name in right] if len(left) == 1 or len(right) == 1 else list(left)
        if isinstance(formula, And) == (equality is part):  # a conjunction with it, or a disjunction with its negation
            if not common:
                return None
            if len(common) == 1:
                terms = {**terms, equality.left: common, equality.right: common}
        elif len(left) == len(right) == len(common) == 1:
            return None
    return terms


def mentioned(formula: Formula, terms: Terms, changed: Changed, world: StaticWorld) -> Iterator[Fact]:
    """The changed facts that a formula mentions, for all objects of its variables."""
    for atom, choices in atoms_of(formula, terms, world):
        facts = changed.get(atom.predicate, frozenset())
        if all(len(objects) == 1 for objects in choices):  # most atoms: no need to look at every fact
            yield from facts & {(atom.predicate, *(name for (name,) in choices))}
        else:
            yield from (fact for fact in facts if _fits(atom.terms, fact[1:], choices))


def _fits(names: Sequence[str], objects: Sequence[str], choices: Choices) -> bool:
    """Whether names can stand for these objects, of those that each may choose from, and each for one only."""
    own_of = dict(zip(names, objects, strict=True))
    return all(
        own_of[name] == actual and actual in own for name, actual, own in zip(names, objects, choices, strict=True)
    )
