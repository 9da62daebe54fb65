"""Wide search for a subgoal among objects: its best candidates begin the search that decides.

Objects split the ground into basins: on either side of each, for each way of turning. A quick search settles in one of
them early, and was 0.8 s from the best subgoal of the kitchen's drives in the mean, in a quarter of them more than 1 s.
"""

from __future__ import annotations

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.values import Array
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.solvers.differential import Crowd, DifferentialEvolution
from tailor.executive.refinement.solvers.solver import Limits

# With the next search they leave 0.08 s on training starts, half as many 0.15 s; 1024 draws instead left 0.35 s
GENERATIONS = 80
CROWD = Crowd(64, 0.2)
N_BEST = 12  # half of the next search's smallest population; the others are starts of the sequence, or drawn anew


class WideSearch:
    """A large crowd at exact arrivals, for which the objective needs a sixth of the model inputs; resumable.

    Args:
      objective: Cost of the sequence with its subgoals.
      rng: The only source of randomness.
    """

    def __init__(self, objective: SequenceObjective, rng: np.random.Generator) -> None:
        seeds, limits = np.empty((0, len(objective.ids))), Limits(GENERATIONS, GENERATIONS)
        self._solver = DifferentialEvolution(ExactArrivals(objective), rng, seeds, limits, CROWD)

    @property
    def best(self) -> Array:
        """The best candidates so far, shape (up to N_BEST, d), best first."""
        return self._solver.elite[:N_BEST]

    def advance(self, budget: Budget) -> bool:
        """Continue until the search is finished (True) or the budget is spent (False)."""
        self._solver.advance(budget)
        return self._solver.finished


class ExactArrivals:
    """An objective as if every arrival were exact: see `SequenceObjective.coarse_stages`.

    Args:
      objective: The exact one.
    """

    def __init__(self, objective: SequenceObjective) -> None:
        self.ranges = objective.ranges
        self._objective = objective

    @property
    def evaluations(self) -> int:
        """See Objective."""
        return self._objective.evaluations

    def __call__(self, candidates: Array) -> Array:
        """See Objective."""
        stages = self._objective.coarse_stages
        costs = self._objective.costs(stages, [candidates[:, stage.columns] for stage in stages])
        total: Array = np.sum(costs, axis=0)
        return total
