"""Selection of the solver for a sequence."""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.chain import ChainSolver
from tailor.executive.refinement.solvers.chain_structure import Columns, blocks_of
from tailor.executive.refinement.solvers.differential import DifferentialEvolution
from tailor.executive.refinement.solvers.genetic import MAX_GENERATIONS, GeneticAlgorithm
from tailor.executive.refinement.solvers.solver import Limits, Solver

MIN_SUBGOALS = 3  # from here on, dynamic programming beats evolution for the same number of model inputs
MAX_PARAMETERS = 2  # of one subgoal: in more dimensions a few candidates are too sparse, above all under constraints


def solver_for(
    objective: SequenceObjective, settings: RefinementSettings, rng: np.random.Generator, seeds: Array
) -> Solver:
    """Solver that the settings name; "auto" selects it by the structure of the sequence.

    "chain" falls back to differential evolution if the sequence is no chain: the structure is no user error.

    Args:
      objective: Cost to minimise.
      settings: Name and limits of the solver.
      rng: The only source of randomness.
      seeds: Initial candidates, shape (s, d); s may be 0.
    """
    limits = Limits(settings.patience, settings.checks_max, settings.worth_s)
    blocks = blocks_of(objective.stages)
    name = settings.solver
    if name == "auto" and blocks is not None:
        name = "chain" if _is_long_chain(blocks) else "differential"
    if blocks is not None and (name == "chain" or not objective.ids):
        return ChainSolver(objective, rng, seeds, settings.batch, limits)
    if name == "genetic":
        return GeneticAlgorithm(objective, rng, seeds, min(settings.checks_max, MAX_GENERATIONS))
    return DifferentialEvolution(objective, rng, seeds, limits)


def _is_long_chain(blocks: tuple[Columns, ...]) -> bool:
    """Whether there are several subgoals with few parameters each."""
    sizes = [len(block) for block in blocks if len(block)]
    return len(sizes) >= MIN_SUBGOALS and max(sizes) <= MAX_PARAMETERS
