"""Chooses among plans the one that the action models predict to be executed fastest.

The planner counts steps; how long they take depends on where and how the robot moves. So some plans are instantiated
and roughly refined, as the one that is executed will be, and their predicted costs compared. A greedy choice alone
misjudges actions that depend on each other: where a ball is best approached depends on where it is dribbled to.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tailor.executive.interfaces.budget import Budget, CheckBudget
from tailor.executive.interfaces.domain import Domain, Scenario
from tailor.executive.interfaces.models import Models
from tailor.executive.interfaces.values import Belief
from tailor.executive.planning import Plan, PlanEnumeration
from tailor.executive.refinement.greedy import GreedySearch
from tailor.executive.refinement.instantiation import Pattern
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence, Failure
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.objective.stage import Prediction
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.executive.refinement.solvers.solver import Solver

MAX_STEPS = 12  # of a plan that is compared: each step takes a few checks
MAX_PLANS = 24  # that are compared, the first one included: all orders of four steps
CHECKS = 2  # batches for the free parameters of each action, chosen greedily
JOINT_CHECKS = 10  # batches for those of all actions together; with more no better ball of two is chosen


class PlanScore:
    """Predicted cost of one plan in seconds, roughly refined; resumable.

    The objective's seconds (mean, k standard deviations, prices of failures and energy) are summed over all actions.
    Unlike in refinement nothing is INVALID: subgoals that would be asserted are not known yet.

    Args:
      sequence: The plan's instantiation, without asserted subgoals.
      models: Loaded models.
      settings: Of refinement.
      rng: Source of every draw, equal for all plans that are compared.
    """

    def __init__(
        self, sequence: ActionSequence, models: Models, settings: RefinementSettings, rng: np.random.Generator
    ) -> None:
        every = len(sequence.actions)
        self._settings = replace(settings, horizon=every, solver="auto", checks_max=JOINT_CHECKS, arrival_spread=())
        self._objective = SequenceObjective(sequence.actions, sequence.variables, models, self._settings)
        self._search = GreedySearch(sequence, models, self._settings, rng)
        self._rng = rng
        self._solver: Solver | None = None  # of all free parameters

    def advance(self, budget: Budget) -> float | None:
        """Continue until the cost is known, infinite if a prediction is not; None if the budget is spent first."""
        while not self._search.finished:
            if budget.spent():
                return None
            self._search.advance_action(CheckBudget(CHECKS))
            self._search.end_action()
        greedy = self._objective.vector(self._search.values)
        if self._solver is None:
            self._solver = solver_for(self._objective, self._settings, self._rng, greedy[None])
        self._solver.advance(budget)
        if not self._solver.finished:
            return None
        predictions = self._objective.predict(greedy if self._solver.best is None else self._solver.best)
        cost_s: float = sum(map(self._cost_s, predictions))
        return cost_s if math.isfinite(cost_s) else math.inf  # nan is less than nothing, and nothing less than it

    def _cost_s(self, predicted: Prediction) -> float:
        """Cost of one action, of which one choice was predicted; 0 J where energy has no weight."""
        settings = self._settings
        seconds = predicted.duration_s[0] + settings.k_std * predicted.std_s[0] + predicted.failure_s[0]
        return float(seconds + settings.energy_weight * predicted.energy_j[0])


class PlanChoice:
    """Comparison of the planner's first plan with others; resumable, `best` is always the answer so far."""

    def __init__(self, first: Plan, others: PlanEnumeration, score: Callable[[Plan], PlanScore | None]) -> None:
        """Prepare the comparison; all work is done in `advance`.

        Args:
          first: The planner's plan.
          others: Other plans for the same problem.
          score: Of a sound plan that can be instantiated; else None.
        """
        self.best = first
        self.costs_s: list[float] = []  # predicted, of the plans compared
        self._others = others
        self._score = score
        self._plan = first
        self._running = score(first)

    def advance(self, budget: Budget) -> bool:
        """Continue until all plans are compared (True) or the budget is spent (False)."""
        while self._running is not None or not self._others.finished:
            if self._running is None:
                plan = self._others.advance(budget)
                if plan is None:
                    if self._others.finished:
                        break
                    return False
                self._plan, self._running = plan, self._score(plan)
                continue
            cost_s = self._running.advance(budget)
            if cost_s is None:
                return False
            self._running = None
            if not self.costs_s or cost_s < min(self.costs_s):
                self.best = self._plan
            self.costs_s.append(cost_s)
            if len(self.costs_s) >= MAX_PLANS:
                break
        return True


def score_for(
    domain: Domain, scenario: Scenario, models: Models, settings: RefinementSettings, belief: Belief, seed: list[int]
) -> Callable[[Plan], PlanScore | None]:
    """How plans are scored from one belief.

    Args:
      domain: Action library.
      scenario: Places of labels.
      models: Loaded models.
      settings: Of refinement.
      belief: From which parameters are instantiated.
      seed: Of the draws, the same for every plan.
    """

    def score(plan: Plan) -> PlanScore | None:
        if not 0 < len(plan.steps) <= MAX_STEPS:
            return None
        sequence = Pattern(plan, domain, scenario).sequence(belief)
        if isinstance(sequence, Failure):
            return None
        return PlanScore(sequence, models, settings, np.random.default_rng(seed))

    return score
