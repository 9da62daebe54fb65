"""Reads a PDDL domain: requirements, types, constants, predicates, functions, actions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tailor.executive.planning.pddl.action_reader import NUMERIC_EFFECTS, read_action
from tailor.executive.planning.pddl.derived_reader import with_derived
from tailor.executive.planning.pddl.formula_reader import CONNECTIVES, Scope
from tailor.executive.planning.pddl.language import Domain, Typed
from tailor.executive.planning.pddl.numeric_reader import ARITHMETIC
from tailor.executive.planning.pddl.syntax.s_expressions import (
    Form,
    Node,
    Word,
    form_of,
    name_of,
    parts_in_order,
    read_form,
    word_of,
)
from tailor.executive.planning.pddl.typed_lists import MAX_OBJECTS, ancestors_of, read_typed, read_types, variables_of

SUPPORTED = frozenset(
    {
        ":strips", ":typing", ":equality", ":negative-preconditions", ":disjunctive-preconditions",
        ":existential-preconditions", ":universal-preconditions", ":quantified-preconditions",
        ":conditional-effects", ":adl", ":durative-actions", ":duration-inequalities", ":time",
        ":timed-initial-literals", ":action-costs", ":derived-predicates", ":fluents", ":numeric-fluents",
    }
)  # fmt: skip
_FIRST = (":types", ":constants", ":predicates", ":functions")
_ACTIONS = frozenset({":action", ":durative-action"})
_OTHER_PARTS = {
    ":axiom": "a derived predicate (axiom)",
    ":constraints": "a trajectory constraint",
    ":process": "a process",
    ":event": "an event",
    ":safety": "a safety constraint",
}
_REPEATED = _ACTIONS | {":requirements", ":derived", *_OTHER_PARTS}  # the last are rejected by name


def parse_domain(text: str, source: str = "domain") -> Domain:
    """Reads a domain.

    Args:
      text: PDDL 2.1; lower and upper case are equal.
      source: Name of the text in errors, e.g. its file name.

    Returns:
      The domain, names in lower case.

    Raises:
      PddlError: Malformed text, as "source:line:column: reason"; `Unsupported` for PDDL outside the language.
    """
    form = read_form(text, source)
    name = define_name(form, "domain")
    domain = Domain(name, {"object": ()}, {"object": frozenset({"object"})}, (), {}, {}, ())
    parts = parts_in_order(form, "a part such as (:action ...)", _FIRST, _REPEATED)
    for part in parts:
        domain = _declare(part, domain)
    domain = with_derived(domain, [part for part in parts if part.head == ":derived"])
    scope = Scope.of(domain, ())
    actions = tuple(read_action(part, scope) for part in parts if part.head in _ACTIONS)
    _reject_duplicates([part for part in parts if part.head in _ACTIONS])
    return replace(domain, actions=actions)


def define_name(form: Form, kind: str) -> str:
    """The name in (define (kind name) ...)."""
    if form.head != "define" or len(form.items) < 2:
        raise form.place.error(f"expected (define ({kind} ...) ...)")
    title = form_of(form.items[1], f"({kind} name)")
    if title.head != kind or len(title.items) != 2:
        found = f", found ({title.head} ...)" if title.head not in (kind, "") else ""
        raise title.place.error(f"expected ({kind} name){found}")
    return name_of(title.items[1], f"the {kind}'s name")


def _declare(form: Form, domain: Domain) -> Domain:
    """The domain with one more declaration; derived predicates and actions are read after all declarations."""
    rest = form.items[1:]
    match form.head:
        case ":requirements":
            check_requirements(rest)
            return domain
        case ":types":
            types = read_types(form)
            return replace(domain, types=types, ancestors=ancestors_of(types))
        case ":constants":
            constants = read_typed(rest, domain.types)
            if len(constants) > MAX_OBJECTS:
                raise form.place.error(f"more than {MAX_OBJECTS} constants")
            return replace(domain, constants=constants)
        case ":predicates":
            _reject_names(rest, CONNECTIVES | NUMERIC_EFFECTS, "predicate")
            return replace(domain, predicates=_signatures(rest, domain))
        case ":functions":
            _reject_names(rest, ARITHMETIC, "function")
            return replace(domain, functions=_signatures(_without_types(rest), domain))
        case head if head in _ACTIONS or head == ":derived":
            return domain
        case head if head in _OTHER_PARTS:
            raise form.place.unsupported(_OTHER_PARTS[head])
        case head:
            raise form.place.error(f"unknown part '{head}' of a domain")


def check_requirements(nodes: list[Node]) -> None:
    """Raises PddlError for what is no requirement, `Unsupported` for one outside the planner's language."""
    for node in nodes:
        word = word_of(node, "a requirement")
        if word[0] != ":":
            raise node.place.error(f"expected a requirement such as :typing, found '{word}'")
        if word not in SUPPORTED:
            raise node.place.unsupported(f"the requirement {word}")


def _signatures(nodes: list[Node], domain: Domain) -> Mapping[str, tuple[Typed, ...]]:
    signatures: dict[str, tuple[Typed, ...]] = {}
    for node in nodes:
        form = form_of(node, "(name ?parameter ...)")
        name = name_of(form.items[0], "a name") if form.items else ""
        if name in signatures or not name:
            raise form.place.error(f"'{name}' is declared twice" if name else "expected a name")
        signatures[name] = variables_of(Form(form.place, form.items[1:]), domain.types)
    return signatures


def _reject_names(nodes: list[Node], taken: frozenset[str], kind: str) -> None:
    """Raises at a name that no condition, effect or number could use, because it means something else there."""
    for node in nodes:
        if isinstance(node, Form) and node.head in taken:
            raise node.items[0].place.error(f"'{node.head}' cannot be the name of a {kind}")


def _without_types(nodes: list[Node]) -> list[Node]:
    """Function declarations without their result type `- number`."""
    kept: list[Node] = []
    words = iter(nodes)
    for node in words:
        if isinstance(node, Word) and node.text == "-":
            kind = next(words, node)
            if not isinstance(kind, Word) or kind.text != "number":
                raise node.place.unsupported("a function that is not '- number'")
        else:
            kept.append(node)
    return kept


def _reject_duplicates(actions: list[Form]) -> None:
    seen: set[str] = set()
    for action in actions:
        name = word_of(action.items[1], "the action's name")
        if name in seen:
            raise action.items[1].place.error(f"the action '{name}' is declared twice")
        seen.add(name)
