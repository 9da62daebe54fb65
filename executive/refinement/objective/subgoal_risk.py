"""Risk that the way to an asserted subgoal spoils the action after it, e.g. by hitting the ball (paper 7)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tailor.executive.interfaces.results import name_of, wrong_result
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.sequence import InstantiatedAction, Variable

RiskToNext = Callable[[Array], Array]  # parameters of a subgoal action, shape (n, p), to risks 0..1, shape (n,)


def risk_to_next(
    action: InstantiatedAction, following: InstantiatedAction | None, variables: tuple[Variable, ...]
) -> RiskToNext | None:
    """Risk that `action` poses to the action after it; None if `action` leads to no asserted subgoal or poses no risk.

    Free parameters of the following action are passed as NaN. A NaN risk counts as zero.
    """
    if following is None or not action.asserted or following.asserted or following.action.subgoal_risk is None:
        return None
    risk = following.action.subgoal_risk
    values = np.array([np.nan if (value := variables[i].value) is None else value for i in following.variables])

    def checked(parameters: Array) -> Array:
        returned: Any = risk(parameters, values)
        risks = np.asarray(returned)
        if risks.dtype.kind not in "fiub" or risks.shape not in ((), (len(parameters),)):
            raise wrong_result(f"{name_of(risk)}, a subgoal_risk,", returned, "one risk for each row of subgoals")
        finite: Array = np.nan_to_num(risks, nan=0.0)
        return finite

    return checked
