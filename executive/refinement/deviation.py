"""The price of uncertainty in the comparison with the greedy choice.

Runs with equal choices take equally long. So only a deviation from the greedy choice can make a run slower, and it
does where the predicted gain is smaller than the error of its prediction.
"""

from __future__ import annotations

import math

from tailor.executive.refinement.objective.choice import Choice
from tailor.executive.refinement.objective.settings import RefinementSettings

MAX_STD_S = 1e100  # of which the square is still a number, whatever a model predicts


def required_gain_s(greedy: Choice, settings: RefinementSettings) -> float:
    """The predicted gain in seconds from which another choice is taken instead of the greedy one.

    It is `gain_k_std` standard deviations of the difference. The errors of the two predictions count as independent
    and equally large: so it is the same for all choices, and more search never returns to the greedy one.
    """
    if not greedy.valid:
        return 0.0
    stds_s = [min(std_s, MAX_STD_S) for std_s in greedy.std_s]
    return settings.gain_min_s + settings.gain_k_std * math.sqrt(2 * sum(std_s**2 for std_s in stds_s))
