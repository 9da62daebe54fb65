"""How near a choice is to the best that the models know: the same search again, many times as long."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.refinement.refinement import Refinement
from tailor.tools.viewer.explanations.decided_sequence import Decided

CHECKS = 1500  # live, a decision has some 100 to 300


def best_cost(decided: Decided, rng: np.random.Generator, checks: int = CHECKS) -> float:
    """The least objective that a long search finds, the choice itself included; no proof of the optimum."""
    settings = replace(decided.settings, patience=checks, checks_max=checks)
    settings = replace(settings, gain_min_s=0.0, gain_k_std=0.0)  # otherwise the greedy search takes all checks
    search = Refinement(decided.sequence, decided.models, settings, rng, start=decided.chosen)
    search.advance(CheckBudget(checks))
    assert search.choice is not None, "the first check yields a choice"
    return search.choice.total_s
