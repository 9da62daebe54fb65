"""Writes atoms and numbers as PDDL text."""

from __future__ import annotations

from tailor.executive.interfaces.values import Fact


def format_atom(fact: Fact) -> str:
    """A fact or ground action in parentheses, e.g. "(robot pos1)"."""
    return f"({' '.join(fact)})"


def format_number(value: float) -> str:
    """A number with at most nine decimals and no trailing zeros: 3, 0.01, 28.04."""
    text = repr(round(float(value), 9))
    if "e" in text:  # of very large and very small numbers
        text = f"{value:.9f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
