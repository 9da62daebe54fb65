"""Reads durations of actions and arithmetic over static functions."""

from __future__ import annotations

import re
from typing import Literal as OneOf
from typing import cast

from tailor.executive.planning.pddl.formula_reader import Scope, expect, read_terms
from tailor.executive.planning.pddl.language import DurationBound, Function, Number, Numeric, Operation, numbers_in
from tailor.executive.planning.pddl.syntax.s_expressions import Form, Node, Word, form_of, word_of

MAX_NUMBERS = 100  # in a duration or a cost, evaluated for every ground action; the domains at hand have 3 at most
ARITHMETIC = frozenset({"+", "-", "*", "/"})
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[-+]?[0-9]+)?")


def read_duration(node: Node, action: Form, scope: Scope) -> tuple[DurationBound, ...]:
    """The bounds of ?duration in seconds; () has none.

    Args:
      node: (= ?duration ...), (<= ?duration ...), (>= ?duration ...), or a conjunction of them.
      action: The action, for its place.
      scope: The action's parameters, and the domain with its functions.

    Raises:
      PddlError: Malformed, or more numbers than `MAX_NUMBERS`; `Unsupported`: a strict limit.
    """
    bounds = _duration(node, scope)
    if sum(numbers_in(bound.value) for bound in bounds) > MAX_NUMBERS:
        raise action.place.error(f"the action's duration has more than {MAX_NUMBERS} numbers")
    return bounds


def read_cost(increase: Form, scope: Scope) -> Numeric:
    """The cost in (increase (total-cost) cost).

    Raises:
      PddlError: Malformed, or more numbers than `MAX_NUMBERS`; `Unsupported`: a negative number.
    """
    expect(increase, 2)
    cost = _numeric(increase.items[2], scope)
    if isinstance(cost, Number) and cost.value < 0:
        raise increase.place.unsupported("a cost below 0")
    if numbers_in(cost) > MAX_NUMBERS:
        raise increase.place.error(f"the action's cost has more than {MAX_NUMBERS} numbers")
    return cost


def _duration(node: Node, scope: Scope) -> tuple[DurationBound, ...]:
    form = form_of(node, "a duration such as (= ?duration 5)")
    if not form.items:
        return ()
    if form.head == "and":
        return tuple(bound for part in form.items[1:] for bound in _duration(part, scope))
    if form.head == "at" and len(form.items) == 3:
        return _duration(form.items[2], scope)
    if form.head in {"<", ">"}:
        raise form.place.unsupported(f"a strict limit of a duration ({form.head} ...)")
    if form.head not in {"=", "<=", ">="}:
        expected = "(= ?duration ...), (<= ?duration ...) or (>= ?duration ...)"
        raise form.place.error(f"expected {expected}, found {form.outline}")
    expect(form, 2)
    if (word := word_of(form.items[1], "?duration")) != "?duration":
        raise form.items[1].place.error(f"expected ?duration, found '{word}'")
    operator = cast(OneOf["=", "<=", ">="], form.head)
    return (DurationBound(operator, _numeric(form.items[2], scope)),)


def _numeric(node: Node, scope: Scope) -> Numeric:
    if isinstance(node, Word):
        return Number(number_of(node))
    if node.head in ARITHMETIC:
        return _operation(node, scope)
    parameters = scope.domain.functions.get(node.head)
    if node.head == "total-cost":
        raise node.place.unsupported("the changing (total-cost) in a number")
    if parameters is None:
        raise node.place.error(f"expected a number or a function, found {node.outline}")
    return Function(node.head, read_terms(node, parameters, scope))


def _operation(form: Form, scope: Scope) -> Numeric:
    operator = cast(OneOf["+", "-", "*", "/"], form.head)
    numbers = [_numeric(item, scope) for item in form.items[1:]]
    if operator == "-" and len(numbers) == 1:
        return Operation("-", (Number(0.0), numbers[0]))
    if len(numbers) < 2:
        raise form.place.error(f"'{operator}' expects two numbers")
    return Operation(operator, tuple(numbers))


def number_of(node: Node) -> float:
    """The number in a word, between -1e9 and 1e9."""
    word = word_of(node, "a number")
    if not _NUMBER.fullmatch(word):
        raise node.place.error(f"expected a number, found '{word}'")
    value = float(word)
    if not -1e9 <= value <= 1e9:
        raise node.place.error(f"expected a number between -1e9 and 1e9, found '{word}'")
    return value
