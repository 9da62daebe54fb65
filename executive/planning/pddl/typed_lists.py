"""Reads PDDL's types and typed lists: `a b - place c - (either cup glass) d`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tailor.executive.planning.pddl.language import Typed
from tailor.executive.planning.pddl.syntax.s_expressions import Form, Node, Word, name_of, word_of

ABOVE_ALL = "the type 'object' is above all others and has none above itself"
MAX_OBJECTS = 10_000  # with the constants
MAX_TYPES = 500  # the largest competition domain has 30


def read_typed(
    nodes: Sequence[Node], declared: Mapping[str, tuple[str, ...]] | None, variables: bool = False
) -> tuple[Typed, ...]:
    """The names of a typed list with their types; a name without a type is an "object".

    Args:
      nodes: The list's items.
      declared: The declared types; None while reading the declaration of the types.
      variables: Whether the names are those of variables, which begin with "?".

    Raises:
      PddlError: An unknown type, a type without names, a name that occurs twice or is none.
    """
    names: list[Typed] = []
    untyped: list[str] = []
    seen: set[str] = set()
    position = 0
    while position < len(nodes):
        word = word_of(nodes[position], "a name")
        if word == "-":
            types = _types(nodes, position, untyped, declared)
            names += [Typed(name, types) for name in untyped]
            untyped = []
            position += 2
            continue
        if variables and word[0] not in "?-":
            raise nodes[position].place.error(f"expected a variable such as ?{word}, found '{word}'")
        if not variables or word[0] == "-":
            name_of(nodes[position], "a variable" if variables else "a name")
        if word in seen:
            raise nodes[position].place.error(f"'{word}' is declared twice")
        seen.add(word)
        untyped.append(word)
        position += 1
    return tuple(names) + tuple(Typed(name) for name in untyped)


def _types(
    nodes: Sequence[Node], dash: int, untyped: list[str], declared: Mapping[str, tuple[str, ...]] | None
) -> tuple[str, ...]:
    place = nodes[dash].place
    if not untyped:
        raise place.error("expected names before '-'")
    if dash + 1 == len(nodes):
        raise place.error("expected a type after '-'")
    node = nodes[dash + 1]
    words = [node] if isinstance(node, Word) else _alternatives(node)
    types = tuple(name_of(word, "a type") for word in words)
    for word, kind in zip(words, types, strict=True):
        if declared is not None and kind not in declared:
            raise word.place.error(f"unknown type '{kind}'")
    return tuple(dict.fromkeys(types))  # each once: every atom over the name compares them


def _alternatives(node: Form) -> list[Node]:
    if node.head != "either" or len(node.items) < 2:
        raise node.place.error("expected a type or (either type ...)")
    return node.items[1:]


def variables_of(form: Form, declared: Mapping[str, tuple[str, ...]]) -> tuple[Typed, ...]:
    """A typed list of variables, each beginning with "?"."""
    return read_typed(form.items, declared, variables=True)


# --- the declaration of types --------------------------------------------------------------------
def read_types(form: Form) -> Mapping[str, tuple[str, ...]]:
    """The types that (:types ...) declares, each with those directly above it; a type without any is an "object".

    Raises:
      PddlError: Malformed, more types than `MAX_TYPES`, or a type above itself.
    """
    types: dict[str, tuple[str, ...]] = {"object": ()}
    for typed in read_typed(form.items[1:], None):
        if typed.name != "object":
            types[typed.name] = typed.types
        elif typed.types != ("object",):
            raise next(n for n in form.items[1:] if isinstance(n, Word) and n.text == "object").place.error(ABOVE_ALL)
    for parents in list(types.values()):
        for parent in parents:  # a parent that is named only behind a dash is a type as well
            types.setdefault(parent, ("object",))
    if len(types) > MAX_TYPES:
        raise form.place.error(f"more than {MAX_TYPES} types")
    _reject_cycles(form, types)
    return types


def ancestors_of(types: Mapping[str, tuple[str, ...]]) -> Mapping[str, frozenset[str]]:
    """By type, itself and all types above it."""
    ancestors = {}
    for kind in types:
        reached, pending = {kind, "object"}, [kind]
        while pending:
            more = [parent for parent in types[pending.pop()] if parent not in reached]
            reached.update(more)
            pending += more
        ancestors[kind] = frozenset(reached)
    return ancestors


def _reject_cycles(form: Form, types: Mapping[str, tuple[str, ...]]) -> None:
    """Raises at the first type that is above itself."""
    for word in form.items[1:]:
        if isinstance(word, Word) and word.text in types and word.text != "object":
            reached: set[str] = set()
            pending = list(types[word.text])
            while pending:
                kind = pending.pop()
                if kind == word.text:
                    raise word.place.error(f"the type '{kind}' is above itself")
                if kind not in reached:
                    reached.add(kind)
                    pending += types[kind]
