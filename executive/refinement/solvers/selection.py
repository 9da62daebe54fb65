"""Which solver for which sequence."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.chain import ChainSolver, Columns, blocks_of
from tailor.executive.refinement.solvers.differential import DifferentialEvolution
from tailor.executive.refinement.solvers.genetic import GeneticAlgorithm
from tailor.executive.refinement.solvers.solver import Limits, Solver

SUBGOALS_MIN = 3  # from so many on, dynamic programming beats evolution for the same number of model rows
PARAMETERS_MAX = 2  # of one subgoal: a few candidates of more dimensions are too thin, under constraints above all


def solver_for(
    objective: SequenceObjective, settings: RefinementSettings, rng: np.random.Generator, seeds: Array
) -> Solver:
    """The solver that the settings name; "auto" goes by the structure of the sequence.

    "chain" falls back to differential evolution where the sequence is no chain: no mistake of the user's.
    """
    limits = Limits(settings.patience, settings.checks_max, settings.worth_s)
    blocks = blocks_of(objective.stages)
    wanted = settings.solver
    if wanted == "auto" and blocks is not None:
        wanted = "chain" if _long_chain(blocks) else "differential"
    if blocks is not None and (wanted == "chain" or not objective.ids):
        return ChainSolver(objective, rng, seeds, settings.batch, limits)
    if wanted == "genetic":
        return GeneticAlgorithm(objective, rng, seeds)
    return DifferentialEvolution(objective, rng, seeds, limits)


def _long_chain(blocks: tuple[Columns, ...]) -> bool:
    """Whether there are several subgoals of few parameters each."""
    sizes = [len(block) for block in blocks if len(block)]
    return len(sizes) >= SUBGOALS_MIN and max(sizes) <= PARAMETERS_MAX
