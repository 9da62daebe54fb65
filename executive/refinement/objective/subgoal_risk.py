"""The risk that a detour spoils what it is made for: a robot that runs into the ball on its way round it (paper 7)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable

Spoiling = Callable[[Array], Array]  # parameters of a detour, shape (n, p), to risks, shape (n,)


def spoiling(
    subgoal_action: InstantiatedAction, action: InstantiatedAction | None, variables: tuple[Variable, ...]
) -> Spoiling | None:
    """How a detour may spoil the action after it; None where it is no detour or nothing is known of such a risk.

    What the action leaves open counts as not a number: a risk that asks for it is none.
    """
    if action is None or not subgoal_action.asserted or action.asserted or action.action.subgoal_risk is None:
        return None
    risk = action.action.subgoal_risk
    known = np.array([np.nan if (value := variables[i].value) is None else value for i in action.variables])
    return lambda parameters: np.nan_to_num(risk(parameters, known), nan=0.0)
