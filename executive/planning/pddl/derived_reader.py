"""Reads derived predicates (PDDL 2.2): (:derived (head ?parameter ...) condition).

A derived predicate that does not depend on itself is an abbreviation: its definition takes its place in every
condition and goal, so that causal links start at the facts that actions change. A recursive one has no such formula.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from tailor.executive.planning.pddl.formula_reader import Scope, read_formula
from tailor.executive.planning.pddl.formula_size import parts_of
from tailor.executive.planning.pddl.language import Definition, Domain, Formula, Or, Typed
from tailor.executive.planning.pddl.substitution import narrowed, substituted
from tailor.executive.planning.pddl.syntax.s_expressions import Form, Node, Word, form_of
from tailor.executive.planning.pddl.typed_lists import variables_of

MAX_PARTS = 100  # of a definition: each use of the predicate is as long


def with_derived(domain: Domain, forms: Sequence[Form]) -> Domain:
    """The domain with the definitions of its derived predicates.

    Args:
      domain: Domain with its types, constants and predicates already read.
      forms: Every (:derived ...) of the domain; several of one predicate are alternatives.

    Raises:
      PddlError: Malformed, or too long; `Unsupported`: recursive.
    """
    rules: dict[str, list[Form]] = {}
    for form in forms:
        rules.setdefault(_head(form, domain).head, []).append(form)
    for name in _in_order(rules):
        domain = replace(domain, derived={**domain.derived, name: _definition(name, rules[name], domain)})
    return domain


def _in_order(rules: Mapping[str, Sequence[Form]]) -> list[str]:
    """The derived predicates, each after those that its definition names."""
    named = {name: set[str]().union(*(_heads(rule.items[2]) for rule in own)) for name, own in rules.items()}
    pending, order = dict.fromkeys(rules), list[str]()
    while pending:
        ready = [name for name in pending if not named[name] & pending.keys()]
        if not ready:
            name = _repeated(named, next(iter(pending)), pending)
            raise rules[name][0].place.unsupported(f"the recursive derived predicate '{name}'")
        order += ready
        pending = dict.fromkeys(name for name in pending if name not in ready)
    return order


def _repeated(named: Mapping[str, set[str]], name: str, among: Collection[str]) -> str:
    """A predicate that depends on itself: the first that occurs twice on a path of dependencies."""
    seen: set[str] = set()
    while name not in seen:
        seen.add(name)
        name = min(named[name].intersection(among))
    return name


def _head(form: Form, domain: Domain) -> Form:
    if len(form.items) != 3:
        raise form.place.error("expected (:derived (predicate ?parameter ...) condition)")
    head = form_of(form.items[1], "(predicate ?parameter ...)")
    if head.head not in domain.predicates:
        raise head.place.error(f"unknown predicate '{head.head}'")
    form_of(form.items[2], "a condition")
    return head


def _heads(node: Node) -> set[str]:
    """The first words of a condition and of its parts: predicates and connectives."""
    if isinstance(node, Word):
        return set()
    parts = node.items[2:] if node.head in {"forall", "exists"} else node.items  # variables may be of (either ...)
    return {node.head}.union(*map(_heads, parts))


def _definition(name: str, rules: Sequence[Form], domain: Domain) -> Definition:
    """The definition by one or more rules."""
    declared = domain.predicates[name]
    alternatives = tuple(_alternative(rule, declared, domain) for rule in rules)
    definition = Definition(declared, alternatives[0] if len(rules) == 1 else Or(alternatives))
    if parts_of(definition.formula) > MAX_PARTS:
        raise rules[0].place.error(f"the definition of '{name}' has more than {MAX_PARTS} parts")
    return definition


def _alternative(rule: Form, declared: tuple[Typed, ...], domain: Domain) -> Formula:
    """The condition of one rule, over the declared parameters."""
    head = form_of(rule.items[1], "(predicate ?parameter ...)")
    own = variables_of(Form(head.place, head.items[1:]), domain.types)
    if len(own) != len(declared):
        plural = "" if len(declared) == 1 else "s"
        raise head.place.error(f"'{head.head}' expects {len(declared)} parameter{plural}, found {len(own)}")
    body = read_formula(rule.items[2], Scope.of(domain, ()).extended(own))
    body = narrowed(body, own, (parameter.types for parameter in declared), domain)
    return substituted(body, {mine.name: parameter.name for mine, parameter in zip(own, declared, strict=True)})
