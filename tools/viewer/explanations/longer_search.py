"""How near a choice is to the best that the models know: the same search again, many times as long."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tailor.executive.interfaces.action import Action
from tailor.executive.interfaces.budget import CheckBudget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.refinement import Refinement
from tailor.schemas.messages import Contexts, Subgoals
from tailor.tools.viewer.explanations.decided_sequence import accepted, chosen_values, sequence_of

CHECKS = 1500  # live, a decision has some 100 to 300


def best_cost(
    message: Subgoals,
    library: Mapping[str, Action],
    models: Models,
    settings: RefinementSettings,
    rng: np.random.Generator,
    checks: int = CHECKS,
    objects: Contexts | None = None,
) -> float:
    """The least objective that a long search finds, the choice itself included; no proof of the optimum.

    Raises:
      ValueError: The library lacks an action of the message.
    """
    sequence = sequence_of(message, library, objects)
    if sequence is None:
        raise ValueError("the library lacks an action of the sequence")
    horizon = min(message.horizon, len(sequence.actions))
    settings = replace(settings, horizon=horizon, patience=checks, checks_max=checks)
    settings = replace(settings, gain_min_s=0.0, gain_k_std=0.0)  # otherwise the greedy search takes all checks
    chosen = chosen_values(message)
    search = Refinement(accepted(sequence, chosen, models, settings), models, settings, rng, start=chosen)
    search.advance(CheckBudget(checks))
    assert search.choice is not None, "the first check yields a choice"
    return search.choice.total_s
