"""Splits a text that holds a domain and a problem, as VHPOP reads from one file or from standard input."""

from __future__ import annotations

import re

from tailor.executive.planning.pddl.errors import error_at

_TOKEN = re.compile(r";[^\n\r]*|[()]")
_HEAD = re.compile(r"\(\s*define\s*\(\s*(domain|problem)\b", re.IGNORECASE)


def split_definitions(text: str, source: str) -> tuple[str, str]:
    """The domain's and the problem's text, each with blanks for the rest, so that places in errors stay right.

    Args:
      text: One (define (domain ...) ...) and one (define (problem ...) ...), in any order; comments are allowed.
      source: Name of the text in errors.

    Raises:
      PddlError: It does not hold one of each.
    """
    found: dict[str, str] = {}
    for start, end in _spans(text):
        head = _HEAD.match(text, start)
        kind = head[1].lower() if head else ""
        if kind and kind in found:
            raise error_at(source, *_place(text, start), f"a second {kind}")
        if kind:
            found[kind] = _blank(text[:start]) + text[start:end]
    for kind in ("domain", "problem"):
        if kind not in found:
            raise error_at(
                source, 1, 1, f"expected a domain and a problem in one text, found no (define ({kind} ...) ...)"
            )
    return found["domain"], found["problem"]


def _spans(text: str) -> list[tuple[int, int]]:
    """Start and end of the outermost parentheses; what is never closed ends with the text."""
    spans, depth, start = [], 0, 0
    for match in _TOKEN.finditer(text):
        if match.group() == "(":
            start = match.start() if depth == 0 else start
            depth += 1
        elif match.group() == ")" and depth:
            depth -= 1
            if depth == 0:
                spans.append((start, match.end()))
    return [*spans, (start, len(text))] if depth else spans


def _blank(text: str) -> str:
    return re.sub(r"[^\n\r]", " ", text)


def _place(text: str, position: int) -> tuple[int, int]:
    lines = text[:position].splitlines() or [""]
    return len(lines), len(lines[-1]) + 1
