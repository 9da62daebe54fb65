"""Reads action schemas: parameters, conditions, effects, durations."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal as OneOf
from typing import cast

from tailor.executive.planning.pddl.formula_reader import (
    Scope,
    expect,
    moment_of,
    read_atom,
    read_formula,
    read_terms,
    read_timed,
)
from tailor.executive.planning.pddl.language import (
    Action,
    Condition,
    DurationBound,
    Effect,
    Function,
    Number,
    Numeric,
    Operation,
)
from tailor.executive.planning.pddl.s_expressions import Form, Node, Word, form_of, word_of
from tailor.executive.planning.pddl.typed_lists import variables_of

NUMERIC_EFFECTS = frozenset({"assign", "increase", "decrease", "scale-up", "scale-down"})
MAX_NUMBERS = 100  # of a duration, which is evaluated for every ground action; the domains at hand have 3 at most
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
    name = word_of(form.items[1], "the action's name")
    parts = _parts(form)
    variables = variables_of(form_of(parts.get(":parameters", Form(form.place)), "parameters"), scope.domain.types)
    if len(variables) > MAX_PARAMETERS:
        raise form.place.error(f"action '{name}' has {len(variables)} parameters, more than {MAX_PARAMETERS}")
    scope = scope.extended(variables)
    durative = form.head == ":durative-action"
    empty = Form(form.place)
    if durative:
        conditions = read_timed(parts.get(":condition", empty), scope)
        bounds: tuple[DurationBound, ...] | None = _bounds(form, parts.get(":duration", empty), scope)
    else:
        conditions = (Condition(read_formula(parts.get(":precondition", empty), scope)),)
        bounds = None
    effect, cost = _without_cost(parts.get(":effect", empty), scope)
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
        raise form.place.unsupported(f"a numeric effect ({form.head} ...)")
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
    return tuple(replace(effect, when=moment) for effect in _effects(form.items[2], scope, False))


def _forall(form: Form, scope: Scope, durative: bool) -> tuple[Effect, ...]:
    expect(form, 2)
    variables = variables_of(form_of(form.items[1], "a list of variables"), scope.domain.types)
    inner = _effects(form.items[2], scope.extended(variables), durative)
    return tuple(replace(effect, variables=variables + effect.variables) for effect in inner)


def _when(form: Form, scope: Scope, durative: bool) -> tuple[Effect, ...]:
    expect(form, 2)
    given = form.items[1]
    condition = read_timed(given, scope) if durative else (Condition(read_formula(given, scope)),)
    inner = _effects(form.items[2], scope, durative)
    if durative and any(effect.when == "start" for effect in inner) and any(c.when != "start" for c in condition):
        raise form.place.unsupported("an effect at start under a condition over all or at end")
    return tuple(replace(effect, condition=condition + effect.condition) for effect in inner)


def _literal(form: Form, scope: Scope) -> Effect:
    if form.head == "not":
        expect(form, 1)
        return Effect(read_atom(form_of(form.items[1], "an atom"), scope), positive=False)
    return Effect(read_atom(form, scope), positive=True)


# --- cost ----------------------------------------------------------------------------------------
def _without_cost(node: Node, scope: Scope) -> tuple[Node, Numeric | None]:
    """The effect without (increase (total-cost) ...), and by how much it increases; only at the effect's top."""
    form = form_of(node, "an effect")
    parts = form.items[1:] if form.head == "and" else [form]
    increases = [part for part in parts if _is_cost(part)]
    if not increases:
        return node, None
    if len(increases) > 1:
        raise increases[1].place.error("(total-cost) is increased twice")
    timed = form_of(increases[0], "an effect")
    increase = form_of(timed.items[2], "an effect") if timed.head == "at" else timed
    expect(increase, 2)
    cost = _numeric(increase.items[2], scope)
    if isinstance(cost, Number) and cost.value < 0:
        raise increase.place.error("expected a cost of at least 0")
    kept = [part for part in parts if part is not increases[0]]
    return Form(form.place, [Word("and", form.place), *kept]), cost


def _is_cost(node: Node) -> bool:
    """Whether this is (increase (total-cost) ...), alone or in (at start ...) or (at end ...)."""
    if not isinstance(node, Form):
        return False
    if node.head == "at" and len(node.items) == 3:
        return _is_cost(node.items[2])
    if node.head != "increase" or len(node.items) < 2:
        return False
    quantity = node.items[1]
    return isinstance(quantity, Form) and quantity.head == "total-cost" and len(quantity.items) == 1


# --- durations -----------------------------------------------------------------------------------
def _bounds(action: Form, node: Node, scope: Scope) -> tuple[DurationBound, ...]:
    bounds = _duration(node, scope)
    if sum(_size(bound.value) for bound in bounds) > MAX_NUMBERS:
        raise action.place.error(f"the action's duration has more than {MAX_NUMBERS} numbers")
    return bounds


def _duration(node: Node, scope: Scope) -> tuple[DurationBound, ...]:
    form = form_of(node, "a duration such as (= ?duration 5)")
    if not form.items:
        return ()
    if form.head == "and":
        return tuple(bound for part in form.items[1:] for bound in _duration(part, scope))
    if form.head == "at" and len(form.items) == 3:
        return _duration(form.items[2], scope)
    if form.head not in {"=", "<=", ">="}:
        raise form.place.error("expected (= ?duration ...), (<= ?duration ...) or (>= ?duration ...)")
    expect(form, 2)
    if word_of(form.items[1], "?duration") != "?duration":
        raise form.items[1].place.error("expected ?duration")
    operator = cast(OneOf["=", "<=", ">="], form.head)
    return (DurationBound(operator, _numeric(form.items[2], scope)),)


def _numeric(node: Node, scope: Scope) -> Numeric:
    if isinstance(node, Word):
        return Number(number_of(node))
    if node.head in {"+", "-", "*", "/"}:
        return _operation(node, scope)
    parameters = scope.domain.functions.get(node.head)
    if parameters is None:
        raise node.place.error(f"expected a number or a function, found '({node.head} ...)'")
    return Function(node.head, read_terms(node, parameters, scope))


def _operation(form: Form, scope: Scope) -> Numeric:
    operator = cast(OneOf["+", "-", "*", "/"], form.head)
    numbers = [_numeric(item, scope) for item in form.items[1:]]
    if operator == "-" and len(numbers) == 1:
        return Operation("-", (Number(0.0), numbers[0]))
    if len(numbers) < 2:
        raise form.place.error(f"'{operator}' expects two numbers")
    return Operation(operator, tuple(numbers))


def _size(number: Numeric) -> int:
    """Number of operands in an arithmetic expression."""
    return sum(map(_size, number.operands)) if isinstance(number, Operation) else 1


def number_of(node: Node) -> float:
    """The number in a word, between -1e9 and 1e9."""
    word = word_of(node, "a number")
    try:
        value = float(word)
    except ValueError:
        raise node.place.error(f"expected a number, found '{word}'") from None
    if not -1e9 <= value <= 1e9:
        raise node.place.error(f"expected a number between -1e9 and 1e9, found '{word}'")
    return value
