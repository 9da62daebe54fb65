"""Which solver for which sequence."""

from __future__ import annotations

import numpy as np

from executive.library import Array
from executive.refinement.chain import ChainSolver, blocks_of
from executive.refinement.differential import DifferentialEvolution
from executive.refinement.genetic import GeneticAlgorithm
from executive.refinement.objective import SequenceObjective
from executive.refinement.settings import RefinementSettings
from executive.refinement.solver import Solver


def solver_for(
    objective: SequenceObjective, settings: RefinementSettings, rng: np.random.Generator, seeds: Array
) -> Solver:
    """The solver that the settings name; "auto" takes the chain solver where the sequence is a chain.

    "chain" falls back to differential evolution likewise: what no chain solver can do is no mistake of the user's.
    """
    limits = (settings.patience, settings.checks_max)
    if settings.solver == "genetic":
        return GeneticAlgorithm(objective, rng, seeds)
    if settings.solver == "differential" or blocks_of(objective.stages) is None:
        return DifferentialEvolution(objective, rng, seeds, *limits)
    return ChainSolver(objective, rng, seeds, settings.batch, *limits)
