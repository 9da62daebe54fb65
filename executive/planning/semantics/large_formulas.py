"""Evaluates formulas in portions: a quantifier may range over more objects than fits into a tick.

`state` has the semantics; small formulas are evaluated there, at once, as are the small parts of a large one.
"""

from __future__ import annotations

from collections.abc import Iterator

from tailor.executive.planning.pddl.formula_size import parts_of
from tailor.executive.planning.pddl.language import And, Formula, Literal, Not, Or, Quantified
from tailor.executive.planning.plans.portions import Work
from tailor.executive.planning.semantics.state import PORTION_PARTS, Binding, Objects, State, holds, negation, support

PARTS_PER_LITERAL = 20  # each becomes a causal link, which is checked and published


def holding(formula: Formula, binding: Binding, state: State, objects: Objects) -> Work[bool]:
    """`holds` in portions.

    Raises:
      TooLargeError: The limit of `objects` is reached.
    """
    if parts_of(formula, objects.of, PORTION_PARTS) <= PORTION_PARTS:
        return holds(formula, binding, state, objects)
    if isinstance(formula, Not):
        return not (yield from holding(formula.part, binding, state, objects))
    every, done = _is_conjunction(formula), 0
    for part, inner, count in _parts_of(formula, binding, objects):
        if (yield from holding(part, inner, state, objects)) != every:
            return not every
        done += count
        if done >= PORTION_PARTS:
            objects.spend(done)
            done = 0
            yield
    return every


def supporting(formula: Formula, binding: Binding, state: State, objects: Objects) -> Work[list[Literal]]:
    """`support` in portions.

    Raises:
      TooLargeError: The limit of `objects` is reached.
    """
    if parts_of(formula, objects.of, PORTION_PARTS) <= PORTION_PARTS:
        return support(formula, binding, state, objects)
    if isinstance(formula, Not):
        return (yield from supporting(negation(formula.part), binding, state, objects))
    every, done, literals = _is_conjunction(formula), 0, list[Literal]()
    for part, inner, count in _parts_of(formula, binding, objects):
        if every:
            more = yield from supporting(part, inner, state, objects)
            literals += more
            done += PARTS_PER_LITERAL * len(more)
        elif (yield from holding(part, inner, state, objects)):
            return (yield from supporting(part, inner, state, objects))
        done += count
        if done >= PORTION_PARTS:
            objects.spend(done)
            done = 0
            yield
    return literals


def _is_conjunction(formula: Formula) -> bool:
    """Whether all parts must hold, not only some."""
    return formula.every if isinstance(formula, Quantified) else isinstance(formula, And)


def _parts_of(formula: Formula, binding: Binding, objects: Objects) -> Iterator[tuple[Formula, Binding, int]]:
    """The parts of a large formula, each with its binding and its size; of a large part 0, as it counts itself."""
    if isinstance(formula, Quantified):
        count = _counted(formula.part, objects)
        for inner in objects.bindings(formula.variables, binding):
            yield formula.part, inner, count
    elif isinstance(formula, And | Or):
        for part in formula.parts:
            yield part, binding, _counted(part, objects)


def _counted(part: Formula, objects: Objects) -> int:
    count = parts_of(part, objects.of, PORTION_PARTS)
    return count if count <= PORTION_PARTS else 0
