"""Splits a text that holds a domain and a problem, as VHPOP reads from one file or from standard input."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tailor.executive.planning.pddl.syntax.errors import PddlError, error_at, place_of

_TOKEN = re.compile(r";[^\n\r]*|[()]|[^\s();]+")
_HEADS: dict[tuple[str, ...], str] = {("(", "define", "(", kind): kind for kind in ("domain", "problem")}


def split_definitions(text: str, source: str) -> tuple[str, str]:
    """The domain's and the problem's text, each with blanks for the rest, so that places in errors stay right.

    Args:
      text: One (define (domain ...) ...) and one (define (problem ...) ...), in any order; comments are allowed.
      source: Name of the text in errors.

    Raises:
      PddlError: It does not hold one of each and nothing else.
    """
    found: dict[str, str] = {}
    for start, end, head in _spans(text, source):
        kind = _HEADS.get(head)
        if kind is None:
            raise _error(source, text, start, "expected (define (domain ...) ...) or (define (problem ...) ...)")
        if kind in found:
            raise _error(source, text, start, f"a second {kind}")
        found[kind] = _blank(text[:start]) + text[start:end]
    for kind in _HEADS.values():
        if kind not in found:
            what = f"expected a domain and a problem in one text, found no (define ({kind} ...) ...)"
            raise error_at(source, 1, 1, what)
    return found["domain"], found["problem"]


def _spans(text: str, source: str) -> Iterator[tuple[int, int, tuple[str, ...]]]:
    """Start, end and the first four words of each outermost list.

    Raises:
      PddlError: Anything but lists and comments, or unbalanced parentheses.
    """
    opened: list[int] = []
    head: list[str] = []
    for match in _TOKEN.finditer(text):
        word = match[0]
        if word[0] == ";":
            continue
        if not opened:
            head = []
        if len(head) < 4:
            head.append(word.lower())
        if word == "(":
            opened.append(match.start())
        elif not opened:
            what = "this parenthesis was never opened" if word == ")" else f"expected '(', found '{word}'"
            raise _error(source, text, match.start(), what)
        elif word == ")":
            start = opened.pop()
            if not opened:
                yield start, match.end(), tuple(head)
    if opened:
        raise _error(source, text, opened[-1], "this parenthesis is never closed")


def _error(source: str, text: str, position: int, what: str) -> PddlError:
    return error_at(source, *place_of(text, position), what)


def _blank(text: str) -> str:
    return re.sub(r"[^\n\r]", " ", text)
