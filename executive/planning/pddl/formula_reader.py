"""Reads conditions and goals; checks every predicate, term and type at its place."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from tailor.executive.planning.pddl.formula_size import parts_of
from tailor.executive.planning.pddl.language import (
    And,
    Atom,
    Condition,
    Domain,
    Equal,
    Formula,
    Not,
    Or,
    Quantified,
    Typed,
    When,
)
from tailor.executive.planning.pddl.substitution import narrowed, substituted
from tailor.executive.planning.pddl.syntax.s_expressions import Form, Node, form_of, word_of
from tailor.executive.planning.pddl.typed_lists import variables_of

MAX_PARTS = 100_000  # of all derived predicates in a text: a sixth of a second
COMPARISONS = frozenset({"<", ">", "<=", ">="})
CONNECTIVES = COMPARISONS | {"and", "or", "not", "imply", "forall", "exists", "=", "when", "preference"}
MOMENTS: Mapping[tuple[str, str], When] = {("at", "start"): "start", ("at", "end"): "end", ("over", "all"): "over"}


@dataclass(frozen=True, slots=True)
class Scope:
    """The names that a formula may use: those of the domain, and the visible terms with their types.

    `parts` counts, for all formulas of a text, the parts that derived predicates became. `fitting` keeps for pairs of
    types whether an object may be of both: an `either` of hundreds is compared once, not for every atom.
    """

    domain: Domain
    terms: Mapping[str, tuple[str, ...]]
    parts: Counter[str] = field(default_factory=Counter, compare=False)
    fitting: dict[tuple[tuple[str, ...], tuple[str, ...]], bool] = field(default_factory=dict, compare=False)

    @classmethod
    def of(cls, domain: Domain, objects: Iterable[Typed]) -> Scope:
        """The scope of a problem's formulas: constants and objects."""
        return cls(domain, {}).extended((*domain.constants, *objects))

    def extended(self, names: Iterable[Typed]) -> Scope:
        """This scope with more terms, which hide earlier ones of the same name."""
        return Scope(self.domain, {**self.terms, **{t.name: t.types for t in names}}, self.parts, self.fitting)

    def may_be(self, term: str, types: tuple[str, ...]) -> bool:
        """Whether the term may be of one of the types."""
        own = self.terms[term]
        if own == types:
            return True
        if (own, types) not in self.fitting:
            ancestors = self.domain.ancestors
            related = any(b in ancestors[a] or a in ancestors[b] for a in own for b in types)
            self.fitting[own, types] = related
        return self.fitting[own, types]


def read_formula(node: Node, scope: Scope) -> Formula:
    """The formula of a condition or goal; () is true.

    Raises:
      PddlError: Not a formula over this scope; `Unsupported` for numeric conditions and preferences.
    """
    form = form_of(node, "a condition")
    if not form.items:
        return And(())
    head, parts = word_of(form.items[0], "a predicate or connective"), form.items[1:]
    match head:
        case "and":
            return And(tuple(read_formula(part, scope) for part in parts))
        case "or":
            return Or(tuple(read_formula(part, scope) for part in parts))
        case "not":
            expect(form, 1)
            return Not(read_formula(parts[0], scope))
        case "imply":
            expect(form, 2)
            return Or((Not(read_formula(parts[0], scope)), read_formula(parts[1], scope)))
        case "forall" | "exists":
            return _quantified(form, scope)
        case "=":
            return _equal(form, scope)
        case "preference":
            raise form.place.unsupported("a preference")
        case _ if head in COMPARISONS:
            raise form.place.unsupported(f"a numeric condition ({head} ...)")
        case _:
            return _defined(_atom(form, scope), form, scope)


def _quantified(form: Form, scope: Scope) -> Formula:
    expect(form, 2)
    variables = variables_of(form_of(form.items[1], "a list of variables"), scope.domain.types)
    part = read_formula(form.items[2], scope.extended(variables))
    return Quantified(form.head == "forall", variables, part)


def _equal(form: Form, scope: Scope) -> Formula:
    expect(form, 2)
    if any(isinstance(item, Form) for item in form.items[1:]):
        raise form.place.unsupported("a numeric condition (= ...)")
    left, right = (_term(item, scope) for item in form.items[1:])
    return Equal(left, right)


def _term(node: Node, scope: Scope) -> str:
    term = word_of(node, "a variable or an object")
    if term not in scope.terms:
        kind = "variable" if term.startswith("?") else "object"
        raise node.place.error(f"unknown {kind} '{term}'")
    return term


def _defined(atom: Atom, form: Form, scope: Scope) -> Formula:
    """The atom, or the definition of its predicate."""
    definition = scope.domain.derived.get(atom.predicate)
    if definition is None:
        return atom
    given = (scope.terms[term] for term in atom.terms)
    formula = narrowed(definition.formula, definition.parameters, given, scope.domain)
    scope.parts["derived"] += parts_of(formula)
    if scope.parts["derived"] > MAX_PARTS:
        raise form.place.error(f"'{atom.predicate}' and other derived predicates take more than {MAX_PARTS} parts")
    names = (parameter.name for parameter in definition.parameters)
    return substituted(formula, dict(zip(names, atom.terms, strict=True)))


def read_atom(form: Form, scope: Scope) -> Atom:
    """An atom of a fact or an effect, over a declared predicate and terms of its parameter types."""
    atom = _atom(form, scope)
    if atom.predicate in scope.domain.derived:
        raise form.place.error(f"'{atom.predicate}' is derived, so it can be neither a fact nor an effect")
    return atom


def _atom(form: Form, scope: Scope) -> Atom:
    if not form.items:
        raise form.place.error("expected an atom such as (predicate argument), found ()")
    name = word_of(form.items[0], "a predicate")
    parameters = scope.domain.predicates.get(name)
    if parameters is None:
        raise form.place.error(f"unknown predicate '{name}'")
    return Atom(name, read_terms(form, parameters, scope))


def read_terms(form: Form, parameters: tuple[Typed, ...], scope: Scope) -> tuple[str, ...]:
    """The terms after the head; number and types match the parameters."""
    expect(form, len(parameters))
    terms = tuple(_term(item, scope) for item in form.items[1:])
    for item, term, parameter in zip(form.items[1:], terms, parameters, strict=True):
        if not scope.may_be(term, parameter.types):
            actual, expected = " or ".join(scope.terms[term]), " or ".join(parameter.types)
            raise item.place.error(f"'{term}' is of type {actual}; '{form.head}' expects {expected}")
    return terms


def expect(form: Form, count: int) -> None:
    """Raises PddlError unless `count` items follow the head."""
    if len(form.items) != count + 1:
        plural = "" if count == 1 else "s"
        raise form.place.error(f"'{form.head}' expects {count} argument{plural}, found {len(form.items) - 1}")


def read_timed(node: Node, scope: Scope) -> tuple[Condition, ...]:
    """The conditions of a durative action: conjunctions of (at start ..), (over all ..), (at end ..)."""
    form = form_of(node, "a timed condition")
    if not form.items:
        return ()
    if form.head == "and":
        return tuple(condition for part in form.items[1:] for condition in read_timed(part, scope))
    if form.head == "forall":
        expect(form, 2)
        variables = variables_of(form_of(form.items[1], "a list of variables"), scope.domain.types)
        inner = read_timed(form.items[2], scope.extended(variables))
        return tuple(Condition(Quantified(True, variables, c.formula), c.when) for c in inner)
    if form.head == "preference":
        raise form.place.unsupported("a preference")
    moment = moment_of(form)
    return (Condition(read_formula(form.items[2], scope), moment),)


def moment_of(form: Form) -> When:
    """The moment that (at start ..), (at end ..) or (over all ..) names."""
    if len(form.items) == 3 and not isinstance(form.items[1], Form):
        moment = MOMENTS.get((form.head, form.items[1].text))
        if moment is not None:
            return moment
    raise form.place.error(f"expected (at start ...), (over all ...) or (at end ...), found {form.outline}")
