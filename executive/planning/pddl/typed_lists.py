"""Reads PDDL's typed lists: `a b - place c - (either cup glass) d`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tailor.executive.planning.pddl.language import Typed
from tailor.executive.planning.pddl.s_expressions import Form, Node, Word, word_of


def read_typed(nodes: Sequence[Node], declared: Mapping[str, tuple[str, ...]] | None) -> tuple[Typed, ...]:
    """The names of a typed list with their types; a name without a type is an "object".

    Args:
      nodes: The list's items.
      declared: The declared types; None while reading the declaration of the types.

    Raises:
      PddlError: An unknown type, a type without names, a name that occurs twice.
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
    types = tuple(word_of(word, "a type") for word in words)
    for word, kind in zip(words, types, strict=True):
        if declared is not None and kind not in declared:
            raise word.place.error(f"unknown type '{kind}'")
    return types


def _alternatives(node: Form) -> list[Node]:
    if node.head != "either" or len(node.items) < 2:
        raise node.place.error("expected a type or (either type ...)")
    return node.items[1:]


def variables_of(form: Form, declared: Mapping[str, tuple[str, ...]]) -> tuple[Typed, ...]:
    """A typed list of variables, each beginning with "?"."""
    variables = read_typed(form.items, declared)
    names = {variable.name for variable in variables}
    for item in form.items:
        if isinstance(item, Word) and item.text in names and item.text[0] != "?":
            raise item.place.error(f"expected a variable such as ?{item.text}, found '{item.text}'")
    return variables
