"""Reads action schemas: parameters, conditions, effects, durations."""

from __future__ import annotations

from dataclasses import replace

from tailor.executive.planning.pddl.formula_reader import (
    Scope,
    expect,
    moment_of,
    read_atom,
    read_formula,
    read_timed,
)
from tailor.executive.planning.pddl.language import (
    Action,
    Condition,
    DurationBound,
    Effect,
    Numeric,
    Typed,
    When,
)
from tailor.executive.planning.pddl.numeric_reader import read_cost, read_duration
from tailor.executive.planning.pddl.substitution import substituted
from tailor.executive.planning.pddl.syntax.s_expressions import Form, Node, form_of, name_of, word_of
from tailor.executive.planning.pddl.typed_lists import variables_of

NUMERIC_EFFECTS = frozenset({"assign", "increase", "decrease", "scale-up", "scale-down"})
UNREADABLE = ";"  # begins a comment, so no name of a text contains it
MAX_PARAMETERS = 100  # binding them is recursive; the competition problems at hand have 9 at most
_PARTS = {
    ":action": (":parameters", ":precondition", ":effect"),
    ":durative-action": (":parameters", ":duration", ":condition", ":effect"),
}
_ONE_OF = {head: f"one of {', '.join(parts)}" for head, parts in _PARTS.items()}


def read_action(form: Form, scope: Scope) -> Action:
    """An action schema.

    Args:
      form: (:action ...) or (:durative-action ...).
      scope: Constants, and the domain with its types, predicates and functions already read.

    Raises:
      PddlError: Malformed, or `Unsupported`: numeric effects, continuous change.
    """
    if len(form.items) < 2:
        raise form.place.error(f"expected a name after {form.head}")
    name = name_of(form.items[1], "the action's name")
    parts = _parts(form)
    variables = variables_of(form_of(parts.get(":parameters", Form(form.place)), "parameters"), scope.domain.types)
    if len(variables) > MAX_PARAMETERS:
        raise form.place.error(f"action '{name}' has {len(variables)} parameters, more than {MAX_PARAMETERS}")
    scope = scope.extended(variables)
    durative = form.head == ":durative-action"
    empty = Form(form.place)
    if durative:
        conditions = read_timed(parts.get(":condition", empty), scope)
        bounds: tuple[DurationBound, ...] | None = read_duration(parts.get(":duration", empty), form, scope)
    else:
        conditions = (Condition(read_formula(parts.get(":precondition", empty), scope)),)
        bounds = None
    effect, cost = _without_cost(parts.get(":effect", empty), scope, durative)
    return Action(name, variables, conditions, _effects(effect, scope, durative), bounds, cost)


def _parts(form: Form) -> dict[str, Node]:
    allowed, one_of = _PARTS[form.head], _ONE_OF[form.head]
    parts: dict[str, Node] = {}
    rest = form.items[2:]
    for key, value in zip(rest[::2], rest[1::2], strict=False):
        word = word_of(key, one_of)
        if word not in allowed:
            raise key.place.error(f"expected {one_of}, found '{word}'")
        if word in parts:
            raise key.place.error(f"'{word}' is given twice")
        parts[word] = value
    if len(rest) % 2:
        raise rest[-1].place.error("expected a value after this")
    return parts


# --- effects -------------------------------------------------------------------------------------
def _effects(node: Node, scope: Scope, durative: bool) -> tuple[Effect, ...]:
    """The effects as single literals; in a durative action each is inside (at start ..) or (at end ..)."""
    form = form_of(node, "an effect")
    if not form.items:
        return ()
    if form.head in NUMERIC_EFFECTS:
        where = " under a condition or a quantifier" if _is_cost(form) else ""
        raise form.place.unsupported(f"a numeric effect ({form.head} ...){where}")
    if form.head == "and":
        return tuple(effect for part in form.items[1:] for effect in _effects(part, scope, durative))
    if form.head == "forall":
        return _forall(form, scope, durative)
    if form.head == "when":
        return _when(form, scope, durative)
    if not durative:
        return (_literal(form, scope),)
    moment = moment_of(form)
    if moment == "over":
        raise form.place.unsupported("an effect over all")
    return tuple(_at(moment, effect) for effect in _effects(form.items[2], scope, False))


def _at(moment: When, effect: Effect) -> Effect:
    """An effect inside (at start ..) or (at end ..): it happens at that moment, and depends on what holds then."""
    return replace(effect, when=moment, condition=tuple(replace(part, when=moment) for part in effect.condition))


def _forall(form: Form, scope: Scope, durative: bool) -> tuple[Effect, ...]:
    expect(form, 2)
    variables = variables_of(form_of(form.items[1], "a list of variables"), scope.domain.types)
    inner = _effects(form.items[2], scope.extended(variables), durative)
    hiding = frozenset(variable.name for variable in variables if variable.name in scope.terms)
    if hiding:  # a condition around the effect may read what they hide, and is joined to its own
        return tuple(_renamed(effect, variables, hiding) for effect in inner)
    return tuple(replace(effect, variables=variables + effect.variables) for effect in inner)


def _renamed(effect: Effect, variables: tuple[Typed, ...], hiding: frozenset[str]) -> Effect:
    """The effect for all choices of the variables, with names for the hiding ones that no text contains."""
    marks = 1 + max((variable.name.count(UNREADABLE) for variable in effect.variables), default=0)
    terms = {name: name + UNREADABLE * marks for name in hiding}
    named = tuple(replace(variable, name=terms.get(variable.name, variable.name)) for variable in variables)
    atom = replace(effect.atom, terms=tuple(terms.get(term, term) for term in effect.atom.terms))
    condition = tuple(replace(part, formula=substituted(part.formula, terms)) for part in effect.condition)
    return replace(effect, atom=atom, variables=named + effect.variables, condition=condition)


def _when(form: Form, scope: Scope, durative: bool) -> tuple[Effect, ...]:
    expect(form, 2)
    given = form.items[1]
    condition = read_timed(given, scope) if durative else (Condition(read_formula(given, scope)),)
    moments = {part.when for part in condition} if durative else set()
    if "over" in moments:
        raise form.place.unsupported("an effect under a condition over all")
    inner = _effects(form.items[2], scope, durative)
    if "end" in moments and any(effect.when == "start" for effect in inner):
        raise form.place.unsupported("an effect at start under a condition at end")
    return tuple(replace(effect, condition=condition + effect.condition) for effect in inner)


def _literal(form: Form, scope: Scope) -> Effect:
    if form.head == "not":
        expect(form, 1)
        return Effect(read_atom(form_of(form.items[1], "an atom"), scope), positive=False)
    return Effect(read_atom(form, scope), positive=True)


# --- cost ----------------------------------------------------------------------------------------
def _without_cost(node: Node, scope: Scope, durative: bool) -> tuple[Node, Numeric | None]:
    """The effect without (increase (total-cost) ...), and by how much it increases; not under "when" or "forall"."""
    increases: list[Form] = []
    kept = _stripped(node, durative, increases)
    if not increases:
        return node, None
    if len(increases) > 1:
        raise increases[1].place.error("(total-cost) is increased twice")
    return kept, read_cost(increases[0], scope)


def _stripped(node: Node, durative: bool, increases: list[Form]) -> Node:
    """The effect with () for each cost in it, its conjunctions and its (at start ...) and (at end ...)."""
    if not isinstance(node, Form):
        return node
    if _is_cost(node):
        increases.append(node)
        return Form(node.place)
    if node.head == "and":
        return Form(node.place, [node.items[0], *(_stripped(part, durative, increases) for part in node.items[1:])])
    if durative and node.head == "at" and len(node.items) == 3:
        return Form(node.place, [*node.items[:2], _stripped(node.items[2], durative, increases)])
    return node


def _is_cost(form: Form) -> bool:
    """Whether this is (increase (total-cost) ...)."""
    if form.head != "increase" or len(form.items) < 2:
        return False
    quantity = form.items[1]
    return isinstance(quantity, Form) and quantity.head == "total-cost" and len(quantity.items) == 1
