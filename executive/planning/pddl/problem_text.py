"""Writes a problem as PDDL 2.1, for an external planner."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal

from tailor.executive.planning.pddl.formula_text import format_atom
from tailor.executive.planning.pddl.language import Typed
from tailor.executive.planning.pddl.problem import Problem


def format_problem(problem: Problem) -> str:
    """The problem as PDDL.

    Args:
      problem: Any problem.

    Returns:
      Text that `parse_problem` reads back as an equal problem; one object, fact or value per line.
    """
    typed = any(item.types != ("object",) for item in problem.objects)
    lines = [
        f"(define (problem {problem.name}) (:domain {problem.domain.name})",
        "  (:objects",
        *(f"    {_object(item, typed)}" for item in problem.objects),
        "  )",
        "  (:init",
        *(f"    {line}" for line in _initial(problem)),
        "  )",
        f"  (:goal {problem.goal_text})",
    ]
    if problem.metric:
        quantity = "total-time" if problem.metric == "makespan" else "total-cost"
        lines.append(f"  (:metric minimize ({quantity}))")
    return "\n".join(lines) + "\n)\n"


def _object(item: Typed, typed: bool) -> str:
    """An object with its type; without types if all objects are untyped, for planners without :typing."""
    if not typed:
        return item.name
    types = item.types[0] if len(item.types) == 1 else f"(either {' '.join(item.types)})"
    return f"{item.name} - {types}"


def _initial(problem: Problem) -> Iterator[str]:
    yield from map(format_atom, problem.initial)
    yield from (f"(= {format_atom(function)} {_exact(value)})" for function, value in problem.values.items())
    yield from (f"(at {_exact(timed.time_s)} {timed.literal})" for timed in problem.timed)


def _exact(value: float) -> str:
    """A number with all its decimals, without an exponent, which not every planner reads."""
    text = f"{Decimal(repr(float(value))):f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
