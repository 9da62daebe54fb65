"""Expected benefit of a subgoal: the expected cost without it against that with it (beyond the paper).

A hard limit asserts subgoals that are not needed. Here a failure has a price, and the cheaper sequence wins.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tailor.executive.interfaces.budget import Budget
from tailor.executive.interfaces.models import Models
from tailor.executive.refinement.assertion.wide_search import WideSearch
from tailor.executive.refinement.objective.choice import any_of
from tailor.executive.refinement.objective.objective import SequenceObjective
from tailor.executive.refinement.objective.sequence import ActionSequence
from tailor.executive.refinement.objective.settings import RefinementSettings
from tailor.executive.refinement.solvers.selection import solver_for
from tailor.executive.refinement.solvers.solver import Solver


class SubgoalComparison:
    """Short search on both sequences, one after the other, among objects after a wide one for subgoals; resumable.

    Args:
      direct: The sequence without the subgoal.
      with_subgoal: The same with subgoals asserted at `position`.
      position: Index in `direct` of the action that may fail.
      models: Loaded models.
      settings: `risk_cost_s` is the price of a failure, `comparison_checks` the effort on each side.
      rng: The only source of randomness.
    """

    def __init__(
        self,
        direct: ActionSequence,
        with_subgoal: ActionSequence,
        position: int,
        models: Models,
        settings: RefinementSettings,
        rng: np.random.Generator,
    ) -> None:
        limited = replace(settings, checks_max=settings.comparison_checks)
        arrival_ids = frozenset(direct.actions[position - 1].variables) if position else frozenset()
        if direct.actions[position].context:  # both ways may meet an object: neither has a limit, both have the price
            with_subgoal = with_any_risk(with_subgoal)
        else:
            with_subgoal = with_accepted_risk(with_subgoal, position + 1, settings.p_fail_settle)
        end = position + 1 + len(with_subgoal.actions) - len(direct.actions)
        sides = (with_accepted_risk(direct, position, 1.0), position + 1), (with_subgoal, end)
        self._sequences = tuple(sequence for sequence, _ in sides)
        self._objectives = [
            SequenceObjective(sequence.actions[position:end], sequence.variables, models, limited, arrival_ids)
            for sequence, end in sides
        ]
        self._settings = limited
        self._rng = rng
        self._wide = WideSearch(self._objectives[1], rng) if direct.actions[position].context else None
        self._solvers: list[Solver] = []

    def advance(self, budget: Budget) -> bool | None:
        """Whether the sequence with the subgoal has the lower expected cost; None if the budget was spent before."""
        if self._wide is not None and not self._wide.advance(budget):
            return None
        if not self._solvers:
            self._begin()
        for solver in self._solvers:
            solver.advance(budget)
        direct, with_subgoal = self._solvers
        if not (direct.finished and with_subgoal.finished):
            return None
        return with_subgoal.value < direct.value

    def _begin(self) -> None:
        """Begin both searches, among objects from the best candidates of the wide one."""
        for objective, sequence in zip(self._objectives, self._sequences, strict=True):
            starts = objective.vectors(sequence.starts)
            if self._wide is not None and objective is self._objectives[1]:
                starts = np.vstack([starts, self._wide.best])
            self._solvers.append(solver_for(objective, self._settings, self._rng, starts))

    @property
    def cheaper(self) -> ActionSequence:
        """The sequence with the lower expected cost, once both searches have finished; its best values are a start."""
        return self._sequences[self._index].starting_from(self.starts)

    @property
    def starts(self) -> list[dict[int, float]]:
        """Good values by variable id of the sequence with the lower expected cost, the best ones first."""
        objective = self._objectives[self._index]
        candidates = self._solvers[self._index].elite
        if self._wide is not None and self._index:
            candidates = np.vstack([candidates, self._wide.best])
        return [objective.values(candidate) for candidate in candidates]

    @property
    def failure(self) -> float:
        """Predicted probability that it fails; 1 if it has no valid choice."""
        best = self._solvers[self._index].best
        if best is None:
            return 1.0
        return any_of([float(prediction.failure[0]) for prediction in self._objectives[self._index].predict(best)])

    @property
    def _index(self) -> int:
        direct, with_subgoal = self._solvers
        return int(with_subgoal.value < direct.value)


def with_accepted_risk(sequence: ActionSequence, position: int, risk: float) -> ActionSequence:
    """The sequence with failure probability `risk` accepted for the action at `position`."""
    actions = list(sequence.actions)
    actions[position] = replace(actions[position], risk=risk)
    return replace(sequence, actions=tuple(actions))


def has_limit(sequence: ActionSequence) -> bool:
    """Whether subgoals were asserted, and an action of the sequence may not risk more than a limit."""
    subgoals = any(instance.asserted for instance in sequence.actions)
    return subgoals and any(instance.may_fail and instance.risk != 1.0 for instance in sequence.actions)


def with_any_risk(sequence: ActionSequence) -> ActionSequence:
    """The sequence without limits, where no choice keeps them: the least expected cost wins, failures priced."""
    return replace(sequence, actions=tuple(replace(instance, risk=1.0) for instance in sequence.actions))
