"""How large a formula is once all objects stand for its variables: a large one is evaluated or ground in portions."""

from __future__ import annotations

import math
from collections.abc import Callable, Sized

from tailor.executive.planning.pddl.language import And, Formula, Not, Or, Quantified, Typed


def one_object(variable: Typed) -> Sized:
    """Choices of `parts_of` with which it counts a formula as written."""
    return (variable,)


def parts_of(formula: Formula, choices: Callable[[Typed], Sized] = one_object, most: float = math.inf) -> int:
    """The number of atoms and connectives with all objects for the variables; beyond `most` some larger number.

    Args:
      formula: Any.
      choices: The objects of a variable's types.
      most: The counting of a conjunction or disjunction ends above it.
    """
    match formula:
        case Not(part):
            return 1 + parts_of(part, choices, most)
        case And(parts) | Or(parts):
            count = 1
            for part in parts:
                count += parts_of(part, choices, most)
                if count > most:
                    break
            return count
        case Quantified(_, variables, part):
            count = 1 + parts_of(part, choices, most)
            for variable in variables:
                count *= len(choices(variable))
            return count
        case _:
            return 1
