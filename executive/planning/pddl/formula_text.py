"""Writes atoms and numbers as PDDL text."""

from __future__ import annotations

from tailor.executive.interfaces.values import Fact


def format_atom(fact: Fact) -> str:
    """A fact or ground action in parentheses, e.g. "(robot pos1)"."""
    return f"({' '.join(fact)})"


def format_number(value: float) -> str:
    """A number with at most six decimals and no trailing zeros: 3, 0.01, 28.04."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return text or "0"
