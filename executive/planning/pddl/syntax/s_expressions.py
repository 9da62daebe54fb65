"""Reads s-expressions into a tree of words and lists, each with its line and column.

Owns the limits on size and nesting. Of PDDL it implements only the comments and case insensitivity.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import NamedTuple

from tailor.executive.planning.pddl.syntax.errors import LINE_END, PddlError, Unsupported, error_at, place_of, shortened

MAX_CHARACTERS = 250_000  # read in a tenth of a second; the problems at hand have 10 000 at most
MAX_DEPTH = 60  # formulas are walked recursively; no hand-written PDDL nests deeper than 20

_new = tuple.__new__  # makes a named tuple in half the time of its constructor
_TOKEN = re.compile(r";[^\n]*|[()]|[^\s();]+")
_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f-\x9f]")  # no name has them: printed, they command a terminal
# Two names look like one; no message carries half a character, which Python reads where a command line is no text
_INVISIBLE = re.compile(r"[\xad\u061c\u200b\u200e\u200f\u202a-\u202e\u2060-\u206f\ud800-\udfff\ufeff]")


class Place(NamedTuple):  # a tuple, as Word is: there are two for each word of a text
    """A place in a text; line and column count from 1."""

    source: str
    line: int
    column: int

    def error(self, what: str) -> PddlError:
        """An error at this place."""
        return error_at(self.source, self.line, self.column, what)

    def unsupported(self, feature: str) -> Unsupported:
        """An error for a PDDL feature outside the planner's language."""
        return Unsupported(f"{self.source}:{self.line}:{self.column}: {shortened(feature)} is not supported")


class Word(NamedTuple):
    """One token, in lower case."""

    text: str
    place: Place


@dataclass(slots=True)
class Form:
    """A parenthesised list of words and forms."""

    place: Place
    items: list[Word | Form] = field(default_factory=list)

    @property
    def head(self) -> str:
        """The first item's text, or "" when it is not a word."""
        first = self.items[0] if self.items else None
        return first.text if isinstance(first, Word) else ""

    @property
    def outline(self) -> str:
        """The list as an error shows it: its head without the rest."""
        return f"({self.head} ...)" if self.head else "((...) ...)" if self.items else "()"


Node = Word | Form


def read_form(text: str, source: str) -> Form:
    """The single form in a text.

    Raises:
      PddlError: Unbalanced parentheses, words outside the form, control or invisible characters, or a text beyond the
        limits.
    """
    if len(text) > MAX_CHARACTERS:
        raise error_at(source, 1, 1, f"the text has {len(text)} characters, more than {MAX_CHARACTERS}")
    if control := _CONTROL.search(text):
        raise error_at(source, *place_of(text, control.start()), f"a control character, U+{ord(control[0]):04X}")
    if hidden := _INVISIBLE.search(text):
        raise error_at(source, *place_of(text, hidden.start()), f"an invisible character, U+{ord(hidden[0]):04X}")
    stack = [Form(Place(source, 1, 1))]
    for row, line in enumerate(LINE_END.split(text), 1):
        _read_line(line, row, source, stack)
    if len(stack) > 1:
        raise stack[-1].place.error("this parenthesis is never closed")
    return _only(stack[0])


def _read_line(line: str, row: int, source: str, stack: list[Form]) -> None:
    """Appends the words of a line to the innermost open form; `stack` are the open forms."""
    items = stack[-1].items
    for match in _TOKEN.finditer(line):
        token = match[0]
        place = _new(Place, (source, row, match.start() + 1))
        if token == "(":
            if len(stack) > MAX_DEPTH:
                raise place.error(f"parentheses nest deeper than {MAX_DEPTH}")
            form = Form(place)
            items.append(form)
            stack.append(form)
            items = form.items
        elif token == ")":
            if len(stack) == 1:
                raise place.error("this parenthesis was never opened")
            stack.pop()
            items = stack[-1].items
        elif token[0] != ";":
            items.append(_new(Word, (token.lower(), place)))


def _only(top: Form) -> Form:
    for item in top.items:
        if isinstance(item, Word):
            raise item.place.error(f"expected '(', found '{item.text}'")
    if not top.items:
        raise top.place.error("the text is empty; expected (define ...)")
    if len(top.items) > 1:
        raise top.items[1].place.error("expected the end of the text after (define ...)")
    form = top.items[0]
    assert isinstance(form, Form)
    return form


def word_of(node: Node, what: str) -> str:
    """The node's text; raises PddlError if it is a list."""
    if isinstance(node, Word):
        return node.text
    raise node.place.error(f"expected {what}, found a list")


def name_of(node: Node, what: str) -> str:
    """The node's text as a name; raises PddlError if it is a list, a variable, a keyword or begins with a dash."""
    name = word_of(node, what)
    if name[0] in "?:-":
        advice = "; a '-' between names and their type stands alone" if name[0] == "-" else ""
        raise node.place.error(f"expected {what}, found '{name}'{advice}")
    return name


def form_of(node: Node, what: str) -> Form:
    """The node as a list; raises PddlError if it is a word."""
    if isinstance(node, Form):
        return node
    raise node.place.error(f"expected {what}, found '{node.text}'")


def text_of(node: Node) -> str:
    """The node as text in one line, without comments."""
    if isinstance(node, Word):
        return node.text
    return f"({' '.join(text_of(item) for item in node.items)})"


def parts_in_order(form: Form, what: str, order: tuple[str, ...], repeated: frozenset[str]) -> list[Form]:
    """The parts of a definition, sorted so that declarations come before their uses.

    Args:
      form: (define (kind name) part ...).
      what: Description of a part, for errors.
      order: Heads of the parts that come first.
      repeated: Heads of the parts that may occur more than once.

    Raises:
      PddlError: Another part occurs twice, or one has no head.
    """
    parts = [form_of(part, what) for part in form.items[2:]]
    seen: set[str] = set()
    for part in parts:
        if not part.head:
            raise part.place.error(f"expected {what}, found {part.outline}")
        if part.head in seen - repeated:
            raise part.place.error(f"'{part.head}' is given twice")
        seen.add(part.head)
    return sorted(parts, key=lambda part: order.index(part.head) if part.head in order else len(order))
